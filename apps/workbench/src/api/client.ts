// All calls of the server.
import type * as api from "./types";

/** A call that the server refused, or that did not reach it ("server-gone"). */
export class Refused extends Error {
  constructor(
    readonly status: number,
    readonly diagnostic: api.Diagnostic,
  ) {
    super(diagnostic.message);
  }
}

export interface InputsRequest {
  meshes: string[];
  footprints: string;
  reading: Record<string, string>;
}
export interface RunRequest {
  label: string;
  preset: string;
  options: Record<string, string>;
  blocks: string[];
}

export class Client {
  /** Id of this tab, to distinguish its own edits from those of others. */
  readonly id = Math.random().toString(36).slice(2);
  constructor(
    private readonly token: string,
    private readonly base = "",
  ) {}

  status = () => this.json<{ version: string; busy: boolean }>("GET", "/api/status");
  options = () => this.json<api.Options>("GET", "/api/options");
  project = () => this.json<api.Project>("GET", "/api/project");
  open = (request: InputsRequest) => this.json<api.Job>("POST", "/api/project/inputs", request);
  openSample = () => this.json<api.Job>("POST", "/api/project/sample", {});
  /** `folder`: 1 for the folder of the inputs, more for one of its subfolders. */
  upload = (name: string, body: Blob, folder = 1) =>
    this.send<{ path: string }>("PUT", `/api/uploads/${escaped(name)}${folder > 1 ? `?folder=${folder}` : ""}`, body);
  scene = () => this.json<api.Scene>("GET", "/api/scene");
  tiles = () => this.json<api.TileIndex>("GET", "/api/scene/tiles");
  tile = (id: string, signal?: AbortSignal) => this.bytes(`/api/scene/tiles/${escaped(id)}`, signal);
  readTextures = () => this.json<api.Job>("POST", "/api/scene/textures", {});
  tileTexture = (id: string, signal?: AbortSignal) => this.bytes(`/api/scene/tiles/${escaped(id)}/texture`, signal);
  buildingTexture = (run: string, building: string) => this.bytes(this.of(run, `/textures/${escaped(building)}`));
  terrain = (run: string) => this.bytes(this.of(run, "/terrain"));
  basemap = (run: string) => this.bytes(this.of(run, "/basemap"));
  start = (request: RunRequest) => this.json<api.Job>("POST", "/api/runs", request);
  importModel = (path: string) => this.json<api.Job>("POST", "/api/runs/import", { path });
  remove = (run: string) => this.json<unknown>("DELETE", this.of(run));
  rename = (run: string, label: string) => this.json<api.RunSummary>("PATCH", this.of(run), { label });
  report = (run: string) => this.json<unknown>("GET", this.of(run, "/report"));
  buildings = (run: string) =>
    this.json<{ buildings: api.Building[]; history: api.History }>("GET", this.of(run, "/buildings"));
  building = (run: string, id: string) =>
    this.json<{ buildings: api.Building[]; history: api.History }>("GET", this.of(run, `/buildings?building=${escaped(id)}`));
  list = (run: string) => this.json<api.BuildingList>("GET", this.of(run, "/list"));
  modelTile = (run: string, tile: string) =>
    this.json<{ buildings: api.Building[] }>("GET", this.of(run, `/tiles/${escaped(tile)}`));
  search = (run: string, words: string, signal?: AbortSignal) =>
    this.json<{ ids: string[] }>("GET", this.of(run, `/search?words=${escaped(words)}`), undefined, signal);
  layers = (run: string) => this.json<api.Layers>("GET", this.of(run, "/layers"));
  /** Of all buildings, or of one. */
  column = (run: string, attribute: string) =>
    this.json<api.AttributeColumn>("GET", this.of(run, `/column?attribute=${escaped(attribute)}`));
  attributes = (run: string, building?: string) =>
    this.json<api.AttributeTable>("GET", this.of(run, `/attributes${building === undefined ? "" : `?building=${escaped(building)}`}`));
  level = (run: string, lod: string) => this.json<api.LevelOfDetail>("GET", this.of(run, `/levels/${escaped(lod)}`));
  otherModel = (path: string) => this.json<api.OtherModel>("POST", "/api/models", { path });
  alignment = (request: InputsRequest) => this.json<api.Alignment>("POST", "/api/project/alignment", request);
  scores = (run: string) => this.json<api.ScoresNow>("GET", this.of(run, "/scores"));
  errorMaps = (run: string) => this.json<{ maps: api.ErrorMap[] }>("GET", this.of(run, "/error"));
  errorMap = async (run: string, block: string) =>
    new Float32Array(await this.bytes(this.of(run, `/error/${escaped(block)}`)));
  section = (run: string, at: { building: string; part: string; ring: number; edge: number; share: number }) =>
    this.json<api.Section>("GET", this.of(run, `/section?${new URLSearchParams(texts(at))}`));
  sectionOf = (run: string, at: { plan: api.Plan; ring: number; edge: number; share: number }) =>
    this.json<api.Section>("POST", this.of(run, "/section"), at);
  preview = (run: string, changes: api.Change[], signal?: AbortSignal) =>
    this.json<{ buildings: api.RaisedBuilding[] }>("POST", this.of(run, "/preview"), { changes }, signal);
  unedited = (run: string) => this.json<{ buildings: api.RaisedBuilding[] }>("GET", this.of(run, "/unedited"));
  split = (run: string, building: string, part: string, line: api.Point2[]) =>
    this.json<api.Proposal>("POST", this.of(run, "/split"), { building, part, line });
  roofs = (run: string, kind: string, parts: { building: string; part: string; plan: api.Plan }[]) =>
    this.json<{ roofs: api.FittedRoof[] }>("POST", this.of(run, "/roofs"), {
      kind,
      parts: parts.map(({ building, part, plan }) => ({ building, part, plan })),
    });
  merge = (run: string, parts: { building: string; part: string }[]) =>
    this.json<api.Proposal>("POST", this.of(run, "/merge"), { parts });
  edit = (run: string, edit: api.Edit) => this.json<api.Applied>("POST", this.of(run, "/edits"), edit);
  carryOver = (run: string, from: string) =>
    this.json<api.CarriedOver>("POST", this.of(run, "/edits/carry-over"), { from });
  undo = (run: string) => this.json<api.Applied>("POST", this.of(run, "/undo"), {});
  redo = (run: string) => this.json<api.Applied>("POST", this.of(run, "/redo"), {});
  review = (run: string) => this.json<api.Review>("GET", this.of(run, "/review"));
  decide = (run: string, request: api.ReviewRequest) =>
    this.json<{ decided: api.ReviewDecision | null }>("POST", this.of(run, "/review"), request);
  reviewCase = (run: string, building: string) =>
    this.json<api.ReviewCase>("GET", this.of(run, `/review/case?building=${escaped(building)}`));
  reviewFile = () => this.json<api.ReviewFile>("GET", "/api/review");
  mergeReview = (review: api.ReviewFile) => this.json<api.ReviewMerged>("POST", "/api/review/merge", review);
  exported = (run: string, file: string) => this.bytes(this.of(run, `/export/${escaped(file)}`));
  exportAll = (run: string, overwrite: boolean) =>
    this.json<{ folder: string; files: string[]; warnings: api.Diagnostic[] }>("POST", this.of(run, "/export"), { overwrite });
  jobs = () => this.json<{ jobs: api.Job[] }>("GET", "/api/jobs");
  cancel = (job: string) => this.json<unknown>("DELETE", `/api/jobs/${escaped(job)}`);

  /** Calls `on` for every event until aborted. When the connection is lost, calls `onConnection` with the HTTP status (0: no
   *  answer) and connects again. Ends when the token is refused. */
  async events(
    on: (event: api.Event) => void,
    onConnection: (connected: boolean, status: number) => void,
    signal: AbortSignal,
  ) {
    while (!signal.aborted) {
      let status = 0;
      try {
        const response = await fetch(this.base + "/api/events", { headers: this.headers(), signal });
        if (!response.ok || !response.body) {
          status = response.status;
          throw new Error(response.statusText);
        }
        onConnection(true, response.status);
        const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
        let rest = "";
        for (;;) {
          const { value, done } = await reader.read();
          if (done) break;
          rest += value;
          const blocks = rest.split("\n\n");
          rest = blocks.pop() ?? "";
          for (const block of blocks) {
            const data = block
              .split("\n")
              .filter((line) => line.startsWith("data:"))
              .map((line) => line.slice(5).trim())
              .join("\n");
            if (data) on(JSON.parse(data) as api.Event);
          }
        }
      } catch {
        // Reported by onConnection below.
      }
      if (signal.aborted) return;
      onConnection(false, status);
      // Another token is needed; connecting again would fail too.
      if (signal.aborted || status === 401 || status === 403) return;
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }

  private of = (run: string, rest = "") => `/api/runs/${escaped(run)}${rest}`;
  private headers = () => ({ Authorization: `Bearer ${this.token}`, "X-Client": this.id });

  private json<T>(method: string, path: string, body?: unknown, signal?: AbortSignal) {
    const text = body === undefined ? undefined : JSON.stringify(body);
    return this.send<T>(method, path, text, signal, text === undefined ? {} : { "Content-Type": "application/json" });
  }
  private async send<T>(
    method: string,
    path: string,
    body?: BodyInit,
    signal?: AbortSignal,
    headers: Record<string, string> = {},
  ): Promise<T> {
    const response = await this.reach(path, { method, body, signal, headers: { ...this.headers(), ...headers } });
    return (await response.json()) as T;
  }
  private async bytes(path: string, signal?: AbortSignal) {
    return (await this.reach(path, { headers: this.headers(), signal })).arrayBuffer();
  }
  private async reach(path: string, init: RequestInit) {
    let response: Response;
    try {
      response = await fetch(this.base + path, init);
    } catch (e) {
      if (init.signal?.aborted) throw e;
      throw new Refused(0, gone);
    }
    if (response.ok) return response;
    const refusal = (await response.json().catch(() => null)) as api.Refusal | null;
    throw new Refused(
      response.status,
      refusal?.error ?? { ...gone, message: `the server answered with HTTP status ${response.status}` },
    );
  }
}

const gone: api.Diagnostic = {
  severity: "error",
  code: "server-gone",
  message: "the server does not answer; start 'mansard serve' again with the same project",
  subject: "",
};

const escaped = (text: string) => encodeURIComponent(text);
const texts = (values: Record<string, string | number>) =>
  Object.fromEntries(Object.entries(values).map(([key, value]) => [key, String(value)]));
