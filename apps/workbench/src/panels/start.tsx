// The first screen: open the sample, paths on the server's machine, uploaded files, or models of an earlier run.
import { signal } from "@preact/signals";
import * as actions from "../actions";
import type { InputKind } from "../api/types";
import * as state from "../state";
import { Icon } from "./icons";
import { accepted, extensionsOf, sorted, titlesOf } from "./inputs";
import { PlainOptionFields } from "./option_fields";
import { faulty, forInputs, key } from "./options";
import { Progress } from "./progress";
import { guide } from "./steps";

const meshes = signal("");
const footprints = signal("");
const derive = signal(false); // footprints are derived from the mesh
const reading = signal<Record<string, string>>({});
const model = signal("");
const sending = signal("");
const over = signal(false);

const lines = (text: string) =>
  text
    .split("\n")
    .map((l) => l.trim())
    .filter(Boolean);

/** The only input option that is a path has a field of its own. */
const terrainKey = "ingest.terrain";
function setTerrain(path: string) {
  const { [terrainKey]: _, ...rest } = reading.value;
  reading.value = path.trim() ? { ...rest, [terrainKey]: path } : rest;
}

/** Uploads dropped or chosen files, and puts their paths into the form. Models that mansard wrote are opened. */
export async function take(files: File[]) {
  const formats = state.options.value;
  if (!formats) return;
  const kinds = sorted(
    files.map((f) => f.name),
    formats,
    lines(meshes.value).length > 0,
  );
  if (kinds.unknown.length) {
    const list = (of: InputKind) => extensionsOf(formats, of).join(" ");
    actions.showMessage({
      severity: "error",
      code: "input-kind",
      message: `unknown file extension; expected a mesh (${list("mesh")}), a raster (${list("raster")}) or footprints (${list("footprints")})`,
      subject: kinds.unknown.join(", "),
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
    derive.value = false;
  }
}

async function read(e: Event) {
  e.preventDefault();
  const terrain = reading.value[terrainKey]?.trim();
  const job = await actions.openInputs({
    meshes: lines(meshes.value),
    footprints: derive.value ? "" : footprints.value.trim(),
    reading: { ...reading.value, ...(terrain ? { [terrainKey]: terrain } : {}) },
  });
  if (job) state.changingInputs.value = false;
}

async function openModel(e: Event) {
  e.preventDefault();
  const job = await actions.openModel(model.value.trim());
  if (job) state.changingInputs.value = false;
}

async function takeModel(file: File | undefined) {
  if (!file) return;
  const paths = await actions.upload([file], (name) => (sending.value = name));
  sending.value = "";
  if (paths) model.value = paths[0]!;
}

const finding = signal(false);
const found = signal<{ reading: Record<string, string>; reason: string } | "nothing" | null>(null);
/** Looks for a CRS or an offset of the mesh that makes mesh and footprints match. */
async function findOffset() {
  finding.value = true;
  found.value = null;
  const answer = await actions.attempt(
    actions.client.alignment({ meshes: lines(meshes.value), footprints: footprints.value.trim(), reading: reading.value }),
  );
  finding.value = false;
  if (answer) found.value = answer.proposal ?? "nothing";
}

function Alignment({ ready }: { ready: boolean }) {
  const proposal = found.value;
  const words = proposal && proposal !== "nothing" ? Object.entries(proposal.reading) : [];
  return (
    <div class="alignment">
      <button type="button" disabled={!ready || finding.value} onClick={() => void findOffset()}>
        Find an offset
      </button>{" "}
      <span class="quiet" role="status">
        {finding.value
          ? "Comparing mesh and footprints …"
          : proposal === "nothing"
            ? "No CRS and no offset was found by which they match."
            : proposal && !words.length
              ? `They match as they are: ${proposal.reason}.`
              : !proposal && "if mesh and footprints do not match: compares them, and proposes a CRS or an offset of the mesh"}
      </span>
      {proposal && proposal !== "nothing" && words.length > 0 && (
        <p role="status">
          Proposed: {words.map(([name, value]) => `${name} = ${value}`).join(", ")}. {proposal.reason}.{" "}
          <button
            type="button"
            class="small"
            onClick={() => {
              reading.value = { ...reading.value, ...proposal.reading };
              found.value = null;
            }}
          >
            Use it
          </button>
        </p>
      )}
    </div>
  );
}

/** Opens the form with the inputs of the project. */
export function changeInputs() {
  const { inputs, reading: given } = state.project.value ?? {};
  meshes.value = inputs?.given.meshes.join("\n") ?? "";
  footprints.value = inputs?.given.footprints ?? "";
  derive.value = inputs?.given.footprints === "";
  reading.value = { ...given };
  state.changingInputs.value = true;
}

export function Start() {
  const project = state.project.value;
  const formats = state.options.value ?? undefined;
  const all = forInputs(state.options.value?.options ?? []);
  const wrong = faulty(all, reading.value);
  const hasFootprints = derive.value || footprints.value.trim() !== "";
  const ready = lines(meshes.value).length > 0 && hasFootprints && !wrong && !sending.value;
  const job = state.jobs.value.find((j) => j.kind === "read" && (j.state === "running" || j.state === "queued"));
  const drop = (e: DragEvent) => {
    e.preventDefault();
    over.value = false;
    void take([...(e.dataTransfer?.files ?? [])]);
  };
  return (
    <div class="start" role={state.changingInputs.value ? "dialog" : undefined} aria-label="Inputs">
      <div class="start-card">
        <header>
          <div>
            <h1>{project?.inputs ? "Change the inputs" : "Open a mesh and footprints"}</h1>
            <p>
              mansard reconstructs building models from a photogrammetric mesh and building footprints. You can edit
              the models as plans and profiles. Missing footprints can be derived from the mesh.
            </p>
          </div>
          {state.changingInputs.value && (
            <button type="button" class="plain" aria-label="Close" onClick={() => (state.changingInputs.value = false)}>
              <Icon name="close" />
            </button>
          )}
        </header>
        {job && <Progress job={job} />}
        {project?.sample && !project.inputs && (
          <p class="start-sample">
            <button type="button" class="primary" disabled={!!job} onClick={() => {
                guide();
                void actions.openSample();
              }}>
              Open the sample
            </button>
            <span>A small mesh with footprints that comes with mansard.</span>
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
              <span role="status">Uploading {sending.value} …</span>
            ) : (
              <label>
                Drop mesh and footprint files here, or <span class="link">choose files</span>
                <input
                  type="file"
                  multiple
                  accept={formats && accepted(formats, "mesh", "raster", "footprints")}
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
            Mesh: files, folders, 3D Tiles (tileset.json) or rasters of heights, one per line
            <textarea
              rows={3}
              spellcheck={false}
              placeholder={"/data/city/tiles/\n/vsizip//data/city.zip/mesh.obj"}
              value={meshes.value}
              onInput={(e) => (meshes.value = e.currentTarget.value)}
            />
            <Titles of={["mesh", "raster"]} />
          </label>
          <label class="field">
            Footprints: a file or database that GDAL can read
            <input
              type="text"
              spellcheck={false}
              autocomplete="off"
              placeholder="/data/city/footprints.gpkg or PG:host=… dbname=…"
              disabled={derive.value}
              value={derive.value ? "" : footprints.value}
              onInput={(e) => (footprints.value = e.currentTarget.value)}
            />
            <Titles of={["footprints"]} />
          </label>
          <label class="start-draw">
            <input type="checkbox" checked={derive.value} onChange={(e) => (derive.value = e.currentTarget.checked)} />
            No footprints: derive them from the mesh
          </label>
          <label class="field">
            Terrain (optional): a raster of ground heights
            <input
              type="text"
              spellcheck={false}
              placeholder="/data/city/dtm.tif"
              value={reading.value[terrainKey] ?? ""}
              onInput={(e) => setTerrain(e.currentTarget.value)}
            />
          </label>
          <details>
            <summary>Input options</summary>
            <PlainOptionFields
              options={all.filter((o) => key(o) !== terrainKey)}
              values={reading.value}
              onChange={(v) => (reading.value = v)}
            />
          </details>
          {!derive.value && <Alignment ready={ready} />}
          <p class="start-go">
            <button
              type="submit"
              class={project?.sample && !project.inputs ? "" : "primary"}
              disabled={!ready || !!job}
            >
              Read inputs
            </button>
            {wrong && <span class="wrong">{wrong}</span>}
          </p>
        </form>
        <OpenModel />
      </div>
    </div>
  );
}

/** The formats that the server reads. */
function Titles({ of }: { of: InputKind[] }) {
  const formats = state.options.value;
  return formats && <span class="quiet titles">{titlesOf(formats, ...of).join(", ")}</span>;
}

/** Models of an earlier run, with or without the mesh. */
function OpenModel() {
  const formats = state.options.value ?? undefined;
  return (
    <form class="start-model" onSubmit={(e) => void openModel(e)}>
      <label class="field">
        Models that mansard wrote: a file, or a folder of 3D Tiles
        <input
          type="text"
          spellcheck={false}
          placeholder="/data/city/model.glb"
          value={model.value}
          onInput={(e) => (model.value = e.currentTarget.value)}
        />
        <Titles of={["models"]} />
      </label>
      <p class="start-go">
        <button type="submit" disabled={model.value.trim() === "" || sending.value !== ""}>
          Open model
        </button>
        <label>
          or <span class="link">choose a model file</span>
          <input
            type="file"
            accept={formats && `${accepted(formats, "models")},.zip`}
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
