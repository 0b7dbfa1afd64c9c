// The first screen: a sample, paths on the server's disk, or files dropped here.
import { signal } from "@preact/signals";
import * as actions from "../actions";
import * as state from "../state";
import { Icon } from "./icons";
import { OptionFields } from "./option_fields";
import { faulty, forReading, key } from "./options";
import { sorted } from "./inputs";
import { Progress } from "./progress";

const meshes = signal("");
const footprints = signal("");
const draw = signal(false); // there are no footprints
const reading = signal<Record<string, string>>({});
const model = signal("");
const sending = signal("");
const over = signal(false);

const lines = (text: string) =>
  text
    .split("\n")
    .map((l) => l.trim())
    .filter(Boolean);

/** The one option of reading that names a file has a field of its own. */
const terrainKey = "ingest.terrain";
function setTerrain(path: string) {
  const { [terrainKey]: _, ...rest } = reading.value;
  reading.value = path.trim() ? { ...rest, [terrainKey]: path } : rest;
}

async function take(files: File[]) {
  const kinds = sorted(
    files.map((f) => f.name),
    lines(meshes.value).length > 0,
  );
  if (kinds.unknown.length) {
    actions.say({
      severity: "error",
      code: "input-kind",
      message: `not a mesh (OBJ, PLY, OFF, GLB), a raster (GeoTIFF) nor footprints (GeoJSON, GeoPackage, Shapefile): ${kinds.unknown.join(", ")}`,
      subject: "",
    });
    return;
  }
  const paths = await actions.upload(files, (name) => (sending.value = name));
  sending.value = "";
  if (!paths) return;
  const pathOf = (name: string) => paths[files.findIndex((f) => f.name === name)]!;
  if (kinds.meshes.length) meshes.value = [...lines(meshes.value), ...kinds.meshes.map(pathOf)].join("\n");
  if (kinds.terrain.length) setTerrain(pathOf(kinds.terrain[0]!));
  if (kinds.footprints.length) {
    footprints.value = pathOf(kinds.footprints[0]!);
    draw.value = false;
  }
}

async function read(e: Event) {
  e.preventDefault();
  const terrain = reading.value[terrainKey]?.trim();
  const job = await actions.openInputs({
    meshes: lines(meshes.value),
    footprints: draw.value ? "" : footprints.value.trim(),
    reading: { ...reading.value, ...(terrain ? { [terrainKey]: terrain } : {}) },
  });
  if (job) state.asksInputs.value = false;
}

async function openModel(e: Event) {
  e.preventDefault();
  const job = await actions.openModel(model.value.trim());
  if (job) state.asksInputs.value = false;
}

async function takeModel(file: File | undefined) {
  if (!file) return;
  const paths = await actions.upload([file], (name) => (sending.value = name));
  sending.value = "";
  if (paths) model.value = paths[0]!;
}

/** Starts from what the open project was read with. */
export function askInputs() {
  const { inputs, reading: given } = state.project.value ?? {};
  meshes.value = inputs?.given.meshes.join("\n") ?? "";
  footprints.value = inputs?.given.footprints ?? "";
  draw.value = inputs?.given.footprints === "";
  reading.value = { ...given };
  state.asksInputs.value = true;
}

export function Start() {
  const project = state.project.value;
  const all = forReading(state.options.value?.options ?? []);
  const wrong = faulty(all, reading.value);
  const outlines = draw.value || footprints.value.trim() !== "";
  const ready = lines(meshes.value).length > 0 && outlines && !wrong && !sending.value;
  const job = state.jobs.value.find((j) => j.kind === "read" && (j.state === "running" || j.state === "queued"));
  const drop = (e: DragEvent) => {
    e.preventDefault();
    over.value = false;
    void take([...(e.dataTransfer?.files ?? [])]);
  };
  return (
    <div class="start" role={state.asksInputs.value ? "dialog" : undefined} aria-label="Inputs">
      <div class="start-card">
        <header>
          <div>
            <h1>{project?.inputs ? "Read other inputs" : "A city mesh and its footprints"}</h1>
            <p>
              Give a photogrammetric mesh and building footprints: they become clean solids that you can edit as plan
              and profiles. Without footprints, they are drawn from the mesh.
            </p>
          </div>
          {state.asksInputs.value && (
            <button type="button" class="plain" aria-label="Close" onClick={() => (state.asksInputs.value = false)}>
              <Icon name="close" />
            </button>
          )}
        </header>
        {job && <Progress job={job} />}
        {project?.sample && !project.inputs && (
          <p class="start-sample">
            <button type="button" class="primary" disabled={!!job} onClick={() => void actions.openSample()}>
              Open the sample
            </button>
            <span>A small scan with its footprints that comes with the program.</span>
          </p>
        )}
        <form onSubmit={(e) => void read(e)}>
          <div
            class={"drop" + (over.value ? " over" : "")}
            onDragOver={(e) => {
              e.preventDefault();
              over.value = true;
            }}
            onDragLeave={() => (over.value = false)}
            onDrop={drop}
          >
            {sending.value ? (
              <span role="status">Copying {sending.value} …</span>
            ) : (
              <label>
                Drop mesh and footprints here, or <span class="link">choose files</span>
                <input
                  type="file"
                  multiple
                  class="unseen"
                  onChange={(e) => {
                    void take([...(e.currentTarget.files ?? [])]);
                    e.currentTarget.value = "";
                  }}
                />
              </label>
            )}
          </div>
          <label class="field">
            Mesh: files, folders of tiles, a tileset.json or a raster of heights, one a line
            <textarea
              rows={3}
              spellcheck={false}
              placeholder={"/data/city/tiles/\n/vsizip//data/city.zip/mesh.obj"}
              value={meshes.value}
              onInput={(e) => (meshes.value = e.currentTarget.value)}
            />
          </label>
          <label class="field">
            Footprints: any vector source that GDAL reads, a database too
            <input
              type="text"
              spellcheck={false}
              autocomplete="off"
              placeholder="/data/city/footprints.gpkg or PG:host=… dbname=…"
              disabled={draw.value}
              value={draw.value ? "" : footprints.value}
              onInput={(e) => (footprints.value = e.currentTarget.value)}
            />
          </label>
          <label class="start-draw">
            <input type="checkbox" checked={draw.value} onChange={(e) => (draw.value = e.currentTarget.checked)} />
            There are none: draw them from the mesh
          </label>
          <label class="field">
            Terrain: a raster with the ground's heights, if there is one
            <input
              type="text"
              spellcheck={false}
              placeholder="/data/city/dtm.tif"
              value={reading.value[terrainKey] ?? ""}
              onInput={(e) => setTerrain(e.currentTarget.value)}
            />
          </label>
          <details>
            <summary>How to read them</summary>
            <OptionFields options={all.filter((o) => key(o) !== terrainKey)} values={reading.value} onChange={(v) => (reading.value = v)} plain />
          </details>
          <p class="start-go">
            <button
              type="submit"
              class={project?.sample && !project.inputs ? "" : "primary"}
              disabled={!ready || !!job}
            >
              Read
            </button>
            {wrong && <span class="wrong">{wrong}</span>}
          </p>
        </form>
        <OpenModel />
      </div>
    </div>
  );
}

/** Models from an earlier run, with a mesh beside them or without. */
function OpenModel() {
  return (
    <form class="start-model" onSubmit={(e) => void openModel(e)}>
      <label class="field">
        Or models that mansard wrote, in any format but STL: a file, or a folder of tiles
        <input
          type="text"
          spellcheck={false}
          placeholder="/data/city/model.glb"
          value={model.value}
          onInput={(e) => (model.value = e.currentTarget.value)}
        />
      </label>
      <p class="start-go">
        <button type="submit" disabled={model.value.trim() === "" || sending.value !== ""}>
          Open a model…
        </button>
        <label>
          or <span class="link">choose its file</span>
          <input
            type="file"
            class="unseen"
            onChange={(e) => {
              void takeModel(e.currentTarget.files?.[0]);
              e.currentTarget.value = "";
            }}
          />
        </label>
      </p>
    </form>
  );
}
