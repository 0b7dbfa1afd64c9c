// Roofs of a part, of selected parts or of a row in one click, and parts like another.
import { signal } from "@preact/signals";
import { client, showMessage } from "../actions";
import { Refused } from "../api/client";
import * as state from "../state";
import { alike, alongRow, type Place, rowOf } from "./alike";
import { partsOf, withPlan } from "./desk";
import { session } from "./here";
import type { Parts } from "./session";
import { type Shape, shaped, shapes, sharedEdges } from "./shapes";
import { bare, dormerRoof, replaced, structureAt, structuresOf } from "./structures";

type Reach = "part" | "selected" | "row";
const reach = signal<Reach>("part");

/** Parts without the structures on their roofs, and without the holes for these. */
const everyPart = (): Place[] =>
  [...state.run.value!.buildings.keys()].flatMap((building) => {
    const parts = partsOf(building);
    const structures = new Set(structuresOf(parts).map((s) => s.id));
    return parts
      .filter(({ id }) => !structures.has(id))
      .map(({ id }) => ({ building, part: id, plan: bare(parts, id) }));
  });
const isAt = (p: Place, at: { building: string; part: string | null }) => p.building === at.building && p.part === at.part;

/** Neighbours of a part within 60 m. */
function sharedOf(place: Place, all: readonly Place[]): boolean[] {
  const xs = place.plan.outer.points.map((p) => p[0]);
  const ys = place.plan.outer.points.map((p) => p[1]);
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const near = all.filter(
    (p) =>
      !isAt(p, place) &&
      p.plan.outer.points.some(([x, y]) => x > left - 60 && x < right + 60 && y > low - 60 && y < high + 60),
  );
  return sharedEdges(place.plan, near.map((p) => p.plan));
}

/** One edit of several parts: all parts of each building that changes. Dormers follow their slopes. */
function together(changed: readonly Place[]): Parts[] {
  const buildings = [...new Set(changed.map((p) => p.building))];
  return buildings.map((building) => {
    let parts = partsOf(building);
    const lost: string[] = [];
    for (const { part, plan } of changed.filter((c) => c.building === building)) {
      const now = replaced(parts, part, plan);
      parts = now.parts;
      lost.push(...now.lost);
    }
    return { building, parts, lost };
  });
}

/** The parts with the best roofs of a kind for the scan, as the engine fits them; those that cannot have one are left out, and
 *  said. Without a scan, or where it shows nothing, as `otherwise` makes them. */
async function fittedOr(
  places: readonly Place[],
  kind: Shape | "fitted",
  otherwise?: (place: Place) => Place["plan"],
): Promise<Place[]> {
  const run = state.run.value;
  const plain = (place: Place) => (otherwise ? [{ ...place, plan: otherwise(place) }] : []);
  if (!run || !state.sceneRead.value) return places.flatMap(plain);
  try {
    const { roofs } = await client.roofs(run.id, kind, [...places]);
    return roofs.flatMap((roof, i) => {
      const place = places[i]!;
      if (roof.plan) return [{ ...place, plan: roof.plan }];
      if (roof.why?.code === "refine-unseen" || roof.why?.code === "edit-unseen") return plain(place);
      if (roof.why) showMessage({ ...roof.why, severity: "warning", subject: place.part });
      return [];
    });
  } catch (failure) {
    if (failure instanceof Refused) showMessage(failure.diagnostic);
    return [];
  }
}

/** Roof shapes for the selected part, for all selected parts, or for the row that the part is in. */
export function Roofs() {
  const at = state.selection.value!;
  const also = state.also.value;
  if (reach.value === "selected" && !also.length) reach.value = "part";
  const alone = structureAt(partsOf(at.building), at.part) !== null;
  const apply = (shape: Shape) => {
    const own = partsOf(at.building);
    const structure = structureAt(own, at.part);
    if (structure) {
      // A roof of its own; it is not among the parts of a row.
      const plan = own.find((p) => p.id === structure.id)!.plan;
      const roof = dormerRoof(own, structure.id, shape) ?? shaped(plan, shape);
      session.propose(`${shape} roof of ${structure.id}`, withPlan(roof));
      return;
    }
    const all = everyPart();
    const first = all.find((p) => isAt(p, at));
    if (!first) return;
    const row = reach.value === "row";
    const places = row ? rowOf(first, all) : [first, ...(reach.value === "selected" ? all.filter((p) => also.some((a) => isAt(p, a))) : [])];
    const run = state.run.value?.id;
    void fittedOr(places, shape, (place) => {
      const shared = sharedOf(place, all);
      const along = row ? alongRow(place.plan, shared) : null;
      return shaped(place.plan, shape, (i) => shared[i]!, {}, along ?? undefined);
    }).then((changed) => {
      if (!changed.length || state.run.value?.id !== run) return;
      const what = changed.length > 1 ? `${shape} roofs of ${changed.length} parts` : `${shape} roof`;
      session.propose(what, together(changed));
    });
  };
  const fit = () => {
    const all = everyPart();
    const places = all.filter((p) => isAt(p, at) || (reach.value === "selected" && also.some((a) => isAt(p, a))));
    const run = state.run.value?.id;
    void fittedOr(places, "fitted").then((changed) => {
      if (!changed.length || state.run.value?.id !== run) return;
      session.propose(changed.length > 1 ? `${changed.length} roofs fitted to the scan` : "roof fitted to the scan", together(changed));
    });
  };
  const makeAlike = () => {
    const all = everyPart();
    const model = all.find((p) => isAt(p, at));
    if (!model) return;
    const own = sharedOf(model, all);
    const changed = all
      .filter((p) => also.some((a) => isAt(p, a)) && !isAt(p, at))
      .map((place) => ({ ...place, plan: alike(model.plan, place.plan, own, sharedOf(place, all)) }));
    if (changed.length) session.propose(`${changed.length} parts like ${model.part}`, together(changed));
  };
  return (
    <div class="shapes" role="group" aria-label="Roof shape">
      <span class="quiet">Roof</span>
      {shapes.map(({ shape, name, meaning }) => (
        <button key={shape} type="button" class="small" title={meaning} onClick={() => apply(shape)}>
          {name}
        </button>
      ))}
      {!alone && state.sceneRead.value && (
        <button type="button" class="small" title="Move the roof as it is to where the scan has it: gutters, pitches and height" onClick={fit}>
          Fit
        </button>
      )}
      {!alone && <select
        aria-label="Parts that get the roof"
        title="A row is what is joined by walls; its ridge runs through all houses"
        value={reach.value}
        onChange={(e) => (reach.value = e.currentTarget.value as Reach)}
      >
        <option value="part">this part</option>
        {also.length > 0 && <option value="selected">selected parts ({also.length + 1})</option>}
        <option value="row">the whole row</option>
      </select>}
      {!alone && also.length > 0 && (
        <button
          type="button"
          class="small"
          title="Give the other selected parts the roof of this part: with as many corners, its profiles edge by edge; else its shape, eaves and pitch"
          onClick={makeAlike}
        >
          Make alike
        </button>
      )}
    </div>
  );
}
