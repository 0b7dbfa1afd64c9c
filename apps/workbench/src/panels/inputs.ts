// Sorts files into meshes, terrain and footprints by their file extensions, as the server lists them.
import type { InputKind, Options } from "../api/types";

type Formats = Pick<Options, "formats" | "compressed_extensions">;

/** File extensions from which something of this kind can be read, each with its dot. */
export const extensionsOf = ({ formats }: Formats, ...kinds: InputKind[]): string[] => [
  ...new Set(formats.filter((f) => kinds.some((k) => f.reads.includes(k))).flatMap((f) => f.extensions.map((e) => `.${e}`))),
];

/** For the attribute `accept` of a file chooser: the extensions of some kinds, their sidecar files, and compressed files. */
export function accepted(known: Formats, ...kinds: InputKind[]): string {
  const sidecars = known.formats.filter((f) => kinds.some((k) => f.reads.includes(k))).flatMap((f) => f.sidecars);
  const others = [...sidecars, ...known.compressed_extensions].map((e) => `.${e}`);
  return [...new Set([...extensionsOf(known, ...kinds), ...others])].join(",");
}

/** The sorted names. A raster is the terrain if there is a mesh, or if its name says so; otherwise it is the mesh. A file
 *  that can be a mesh or footprints is taken as the mesh if there is none yet. */
export function sorted(names: readonly string[], known: Formats, hasMesh = false) {
  const plain = (name: string) =>
    known.compressed_extensions.reduce((n, e) => (n.endsWith(`.${e}`) ? n.slice(0, -e.length - 1) : n), name.toLowerCase());
  const has = (extensions: readonly string[]) => (name: string) => extensions.some((e) => plain(name).endsWith(e));
  const isMesh = has(extensionsOf(known, "mesh"));
  const isRaster = has(extensionsOf(known, "raster"));
  const isFootprints = has(extensionsOf(known, "footprints"));
  const isSidecar = has(known.formats.flatMap((f) => f.sidecars.map((e) => `.${e}`)));
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
