// The manual behind "?".
const sections: [title: string, text: string][] = [
  [
    "Open data",
    "Open the sample, enter the paths of a mesh and footprints, or drop files on the page. Uploaded files never replace others. If mesh and footprints do not match, “Find an offset” in the form of the inputs compares them and proposes a CRS or an offset of the mesh.",
  ],
  [
    "Run",
    "The panel Run has all options with their meanings. Choose blocks in the view to reconstruct only some. “Carry over” applies the edits of another run to the open one.",
  ],
  [
    "Find buildings",
    "The list of buildings finds ids, blocks, outcomes and attributes: “slanted”, “measuredHeight>12”, “ms_edited=yes”. A click selects a building and moves the camera to it. The panel Attributes has all attributes of the selected building with units and meanings.",
  ],
  [
    "Review",
    "The panel Review goes through the buildings, the worst first: the scan beside the model, the reason for doubt, a mark where scan and model differ most, and other models. r, w and d decide: right, wrong, later. Decisions are kept in the project and written into exports as ms_review; one lapses when its building changes.",
  ],
  [
    "Colours",
    "Layers › Colour by colours the models by any attribute, the error or the outcome. Numbers have a scale that looks nearly the same with any colour vision; categories have different colours, the rarest share one. Level of detail draws the models at LoD 1.2, 1.3 or 2.0. Models of others shows CityJSON or OBJ of another program beside those of the run.",
  ],
  [
    "Section plane",
    "The plane goes through the selected building, across its longest edge. Turn, tilt and move it; cut solids are filled.",
  ],
  [
    "Measure",
    "Distances, heights, angles and areas between points on models, scan and ground. The coordinates under the pointer are those of the files, in their CRS. Backspace removes the last point, Esc ends.",
  ],
  [
    "Align",
    "If mesh and footprints do not match, “Align mesh and footprints” takes pairs of points: a point of the scan, and the corner of a footprint where it should be. Two pairs or more give an offset of the mesh, with what it leaves of each pair. The inputs are read again with it.",
  ],
  [
    "Textures and terrain",
    "Layers › Texture shows the colours of the scan, on the scan and on the models as they are. Layers › Terrain shows the ground around the models; Export writes it.",
  ],
  [
    "Compare",
    "“Compare with” shows a second run beside the open one. “Divide the view” shows both in one image with a boundary that can be dragged; with one run, the scan on its left and the models on its right.",
  ],
  [
    "Edit",
    "Select a part and drag its corners, edges and profile points, or type numbers. Changes are saved when you release the mouse. Invalid plans are shown in red and are not saved. Undo has no limit.",
  ],
  [
    "Roofs over oblique walls",
    "Where a wall is not parallel to the ridge, select it and press “Turn roof”: its roof rises from a corner edge, a dashed line through a corner in the direction of the eaves, and the wall goes up to the roof. Drag the handle of the line, use the arrow keys (0.5°, Shift 5°), or type the direction, clockwise from north. “Fit plane” fits it to the scan. “Remove corner edge” gives the roof back to the wall.",
  ],
  [
    "Roofs",
    "Flat to Mansard show the best roof of that kind for the scan, with the error before and after. Keep or Enter saves it, Discard or Esc goes back; nothing is saved before. Fit moves the roof as it is to the scan, Fit plane the plane of the selected edge alone, and on a dormer its place and size. The list beside them extends this to the selected parts or to the whole row.",
  ],
  [
    "Handles",
    "The roof of the selected part has handles in the view. A ridge goes up and down (the pitches change, the eaves stay) or sideways; an eave takes its roof along; a face moves along its normal. Arrow keys move the handle that has the focus. A value that is typed goes to all selected parts.",
  ],
  [
    "Pictures, links and exports",
    "“Picture and link” saves the view as PNG of any size, or copies a link that restores run, selection, camera and layers. Export writes the edited models in every format; they can be opened again, ZIP files too.",
  ],
];

export function Manual() {
  return (
    <div class="manual">
      {sections.map(([title, text]) => (
        <section key={title}>
          <h3>{title}</h3>
          <p>{text}</p>
        </section>
      ))}
    </div>
  );
}
