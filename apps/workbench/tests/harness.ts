// Starts a server with a new project, opens the page, and fails tests whose page logs errors.
import { type ChildProcess, execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, renameSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { deflateSync } from "node:zlib";
import { type Page, expect, test as base } from "@playwright/test";

const binary = process.env.MANSARD_BINARY;
if (!binary) throw new Error("set MANSARD_BINARY to the path of the program");
export const data = process.env.MANSARD_DATA ?? join(__dirname, "../../../data");

/** Runs the command line; returns its standard output. */
export const mansard = (...words: string[]) => execFileSync(binary, words, { encoding: "utf8" });

export class Server {
  link = "";
  private child: ChildProcess | null = null;
  constructor(readonly project: string) {}

  async start(...more: string[]) {
    const child = spawn(binary!, ["serve", this.project, "--port", "0", "--sample", join(data, "delft"), ...more], {
      stdio: ["ignore", "pipe", "inherit"],
    });
    this.child = child;
    this.link = await new Promise<string>((resolve, reject) => {
      let text = "";
      child.stdout!.on("data", (bytes: Buffer) => {
        text += bytes.toString();
        const link = /http:\/\/\S+#token=\S+/.exec(text);
        if (link) resolve(link[0]);
      });
      child.on("exit", (code) => reject(new Error(`the server ended with ${code} before it printed a link: ${text}`)));
    });
  }
  get origin() {
    return new URL(this.link).origin;
  }
  get token() {
    return this.link.split("#token=")[1];
  }
  async stop(signal: NodeJS.Signals = "SIGTERM") {
    const child = this.child;
    this.child = null;
    if (!child || child.exitCode !== null) return;
    const gone = new Promise((resolve) => child.on("exit", resolve));
    child.kill(signal);
    await gone;
  }
  async get<T>(path: string) {
    const response = await fetch(this.origin + path, { headers: { Authorization: `Bearer ${this.token}` } });
    if (!response.ok) throw new Error(`${path}: ${response.status} ${await response.text()}`);
    return (await response.json()) as T;
  }
}

/** A server with an empty project, and a page that must not log errors. */
export const test = base.extend<{ folder: string; server: Server; clean: Page }>({
  folder: async ({}, use) => {
    const folder = mkdtempSync(join(tmpdir(), "mansard-page-"));
    await use(folder);
    rmSync(folder, { recursive: true, force: true });
  },
  server: async ({ folder }, use) => {
    const server = new Server(join(folder, "project"));
    await server.start();
    await use(server);
    await server.stop();
  },
  clean: async ({ page }, use) => {
    const wrong: string[] = [];
    page.on("pageerror", (error) => wrong.push(String(error)));
    page.on("console", (message) => {
      // The browser logs lost connections and refused edits.
      if (message.type() === "error" && !/ERR_CONNECTION|ERR_INCOMPLETE|ERR_EMPTY|422|409|503/.test(message.text()))
        wrong.push(message.text());
    });
    await use(page);
    if (wrong.length > 0) throw new Error(`the page logged errors:\n${wrong.join("\n")}`);
  },
});
export { expect };

/** The path of the file that the browser saves when `act` is done, moved to `folder`. */
export async function saved(page: Page, folder: string, act: () => Promise<void>) {
  const downloads = process.env.MANSARD_DOWNLOADS;
  if (!downloads) {
    const [download] = await Promise.all([page.waitForEvent("download"), act()]);
    const path = join(folder, download.suggestedFilename());
    await download.saveAs(path);
    return path;
  }
  // Over WebDriver BiDi this version of Playwright does not hear of downloads. The folder of Firefox is empty before each; a
  // file that is not complete stands beside one with the ending ".part".
  await act();
  const complete = () => {
    const names = readdirSync(downloads);
    return names.length === 1 && statSync(join(downloads, names[0]!)).size > 0 ? names[0]! : "";
  };
  await expect.poll(complete).not.toBe("");
  const path = join(folder, complete());
  renameSync(join(downloads, complete()), path);
  return path;
}

/** A screenshot, in the folder MANSARD_PICTURES, or beside the results of the tests. */
export async function picture(page: Page, name: string, when: "when idle" | "at once" = "when idle") {
  const folder = process.env.MANSARD_PICTURES ?? join(process.env.MANSARD_TEST_RESULTS ?? tmpdir(), "pictures");
  mkdirSync(folder, { recursive: true });
  if (when === "when idle")
    await page.evaluate(() => (window as unknown as { mansard: { view: { idle(): Promise<void> } } }).mansard.view.idle());
  await page.screenshot({ path: join(folder, `${name}.png`) });
}

export type Line = [from: [number, number], to: [number, number]];

/** Moves one finger along each line, all at the same time. Playwright itself only taps: this speaks the browser's protocol. */
export async function fingers(page: Page, lines: Line[]) {
  const steps = 8;
  const at = ([a, b]: Line, share: number) => ({ x: a[0] + (b[0] - a[0]) * share, y: a[1] + (b[1] - a[1]) * share });
  if (process.env.MANSARD_BROWSER === "firefox") {
    type Session = { sessionId: string; send(method: string, parameters: object): Promise<unknown> };
    type Inside = { _connection: { toImpl(of: object): { delegate: { _session: Session } } } };
    const session = (page as unknown as Inside)._connection.toImpl(page).delegate._session;
    await session.send("input.performActions", {
      context: session.sessionId,
      actions: lines.map((line, i) => ({
        type: "pointer",
        id: `finger ${i}`,
        parameters: { pointerType: "touch" },
        actions: [
          { type: "pointerMove", ...at(line, 0) },
          { type: "pointerDown", button: 0 },
          ...Array.from({ length: steps }, (_, k) => ({ type: "pointerMove", duration: 20, ...at(line, (k + 1) / steps) })),
          { type: "pointerUp", button: 0 },
        ],
      })),
    });
    return;
  }
  const devtools = await page.context().newCDPSession(page);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", share: number) =>
    devtools.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: type === "touchEnd" ? [] : lines.map((line, id) => ({ ...at(line, share), id })),
    });
  await touch("touchStart", 0);
  for (let k = 1; k <= steps; ++k) await touch("touchMove", k / steps);
  await touch("touchEnd", 1);
  await devtools.detach();
}

/** A square PNG of one colour. */
export function png(side: number, colour: [number, number, number]): Buffer {
  const crc = (bytes: Buffer) => {
    let c = ~0;
    for (const byte of bytes) {
      c ^= byte;
      for (let k = 0; k < 8; ++k) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
    }
    return ~c >>> 0;
  };
  const number = (value: number) => {
    const bytes = Buffer.alloc(4);
    bytes.writeUInt32BE(value);
    return bytes;
  };
  const chunk = (kind: string, content: Buffer) => {
    const body = Buffer.concat([Buffer.from(kind), content]);
    return Buffer.concat([number(content.length), body, number(crc(body))]);
  };
  const row = Buffer.concat([Buffer.from([0]), ...Array.from({ length: side }, () => Buffer.from(colour))]);
  return Buffer.concat([
    Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]),
    chunk("IHDR", Buffer.concat([number(side), number(side), Buffer.from([8, 2, 0, 0, 0])])),
    chunk("IDAT", deflateSync(Buffer.concat(Array.from({ length: side }, () => row)))),
    chunk("IEND", Buffer.alloc(0)),
  ]);
}
