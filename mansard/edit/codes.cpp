#include "mansard/edit/edit.hpp"

namespace mansard::edit {

auto codes() -> std::vector<base::Code> {
  return {
      {"edit-building", "An edit names a building that the run does not have, or one of them twice.",
       "Take the list of buildings again; one change has all parts of its building.", 2},
      {"edit-part", "A building has no part of this id.", "Take the building's state again.", 2},
      {"edit-stale", "The building was changed elsewhere since the state that this edit was made to.",
       "Take the new state and make the edit again.", 2},
      {"edit-empty", "An edit that changes nothing.", "Nothing needs to be done.", 2},
      {"edit-nothing", "There is nothing to undo, or nothing to redo.", "Nothing needs to be done.", 2},
      {"edit-duplicate-id", "Two parts of a building have one id.", "Give one of them another.", 2},
      {"edit-journal", "A line of a run's journal of edits cannot be done again.",
       "Take out that line and those after it, or restore the file; the edits before it are kept.", 3},
      {"edit-overlap", "Two parts overlap by a strip wider than 2 cm, more than 0.01 m².",
       "Move the corners back, or move the neighbour's too.", 2},
      {"edit-overlap-unchecked", "Whether a part shares ground with another one could not be computed.",
       "Move the corners of the part a little, or repair the other outline.", 2},
      {"edit-error", "An edit raises the error of a building against the scan by half or more.",
       "Compare the roof with the scan; undo the edit, or fit the roof.", 0},
      {"edit-above", "An edit makes a building higher than anything that the scan shows over it.",
       "Lower the roof or its pitch; save it where the scan is wrong.", 0},
      {"edit-unseen", "Roofs cannot be fitted, because there is no scan over the building.",
       "Open the inputs of the run, or choose heights by hand.", 2},
      {"edit-split", "A line does not divide a part: it ends inside, crosses itself, or cuts off next to nothing.",
       "Draw it from outside the part to the outside again.", 2},
      {"edit-merge",
       "Two parts cannot become one: they do not share a wall of 0.1 m, overlap, or would touch in a point.",
       "Move their corners together first, or merge them with the part between them.", 2},
  };
}

}  // namespace mansard::edit
