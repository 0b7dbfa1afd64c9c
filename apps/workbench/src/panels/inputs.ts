// Sorts files into meshes, terrain and footprints by their file extensions, as the server lists them.
import type { InputKind, Options } from "../api/types";

type Formats = Pick<Options, "formats" | "compressed_extensions">;

const reading = ({ formats }: Formats, kinds: InputKind[]) =>
  formats.filter((f) => kinds.some((k) => f.reads.includes(k)));

/** Names of the formats from which something of these kinds can be read. */
export const titlesOf = (known: Formats, ...kinds: InputKind[]) => reading(known, kinds).map((f) => f.title);
/** Their file extensions. */
export const extensionsOf = (known: Formats, ...kinds: InputKind[]): string[] => [
  ...new Set(reading(known, kinds).flatMap((f) => f.extensions)),
];

/** For the attribute `accept` of a file chooser: their file extensions, those of sidecar files, and compressed files. The
 *  attribute has no place for extensions of two words, such as .osm.pbf: their last word counts. */
export function accepted(known: Formats, ...kinds: InputKind[]): string {
  const sidecars = reading(known, kinds).flatMap((f) => f.sidecars);
  const all = [...extensionsOf(known, ...kinds), ...sidecars, ...known.compressed_extensions];
  return [...new Set(all.map((e) => e.slice(e.lastIndexOf("."))))].join(",");
}

/** The sorted names. A raster is the terrain if there is a mesh, or if its name says so; otherwise it is the mesh. A file
 *  that can be a mesh or footprints is taken as the mesh if there is none yet. */
export function sorted(names: readonly string[], known: Formats, hasMesh = false) {
  const plain = (name: string) =>
    known.compressed_extensions.reduce((n, e) => (n.endsWith(e) ? n.slice(0, -e.length) : n), name.toLowerCase());
  const has = (extensions: readonly string[]) => (name: string) => extensions.some((e) => plain(name).endsWith(e));
  const isMesh = has(extensionsOf(known, "mesh"));
  const isRaster = has(extensionsOf(known, "raster"));
  const isFootprints = has(extensionsOf(known, "footprints"));
  const isSidecar = has(known.formats.flatMap((f) => f.sidecars));
  const isTerrain = (name: string) => /dtm|dgm|terrain|ground/.test(plain(name));

  const certain = names.filter((n) => isMesh(n) && !isFootprints(n));
  const mesh = hasMesh || certain.length > 0;
  const either = names.filter((n) => isMesh(n) && isFootprints(n));
  const rasters = names.filter(isRaster);
  const taken = mesh || either.length > 0;
  return {
    meshes: names.filter(
      (n) => certain.includes(n) || (!mesh && either.includes(n)) || (!taken && rasters.includes(n) && !isTerrain(n)),
    ),
    terrain: rasters.filter((n) => taken || isTerrain(n)),
    footprints: names.filter((n) => isFootprints(n) && (mesh || !isMesh(n))),
    sidecars: names.filter((n) => isSidecar(n) && !isMesh(n) && !isRaster(n) && !isFootprints(n)),
    unknown: names.filter((n) => ![isMesh, isRaster, isFootprints, isSidecar].some((is) => is(n))),
  };
}
