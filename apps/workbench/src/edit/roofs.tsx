// Roofs of a part, of selected parts or of a row in one click, and parts like another.
import { signal } from "@preact/signals";
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
    const changed = places.map((place) => {
      const shared = sharedOf(place, all);
      const along = row ? alongRow(place.plan, shared) : null;
      return { ...place, plan: shaped(place.plan, shape, (i) => shared[i]!, {}, along ?? undefined) };
    });
    const what = changed.length > 1 ? `${shape} roofs of ${changed.length} parts` : `${shape} roof`;
    session.propose(what, together(changed));
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
