import { describe, expect, it, vi } from "vitest";
import { Client, Refused } from "./client";
import type * as api from "./types";

const answering = (response: () => Response) => {
  const calls: { path: string; init: RequestInit }[] = [];
  vi.stubGlobal("fetch", async (path: string, init: RequestInit) => {
    calls.push({ path, init });
    return response();
  });
  return calls;
};

describe("the client", () => {
  it("sends the token and its id with every call", async () => {
    const calls = answering(() => Response.json({ version: "1", busy: false }));
    const client = new Client("secret");
    await client.status();
    expect(calls[0]!.init.headers).toMatchObject({ Authorization: "Bearer secret", "X-Client": client.id });
  });

  it("escapes names", async () => {
    const calls = answering(() => Response.json({}));
    await new Client("").rename("run 1/..", "x");
    expect(calls[0]!.path).toBe("/api/runs/run%201%2F..");
  });

  it("throws refusals with their diagnostics", async () => {
    const error: api.Diagnostic = { severity: "error", code: "edit-stale", message: "too late", subject: "a" };
    answering(() => Response.json({ error }, { status: 409 }));
    const refused = await new Client("").undo("run-1").catch((e: unknown) => e);
    expect(refused).toBeInstanceOf(Refused);
    expect(refused).toMatchObject({ status: 409, diagnostic: error });
  });

  it("stops to reconnect when the token is refused", async () => {
    const calls = answering(() => new Response("{}", { status: 401 }));
    const told: [boolean, number][] = [];
    await new Client("old").events(
      () => {},
      (there, status) => {
        told.push([there, status]);
      },
      new AbortController().signal,
    );
    expect(told).toEqual([[false, 401]]);
    expect(calls).toHaveLength(1);
  });

  it("assembles events from pieces of any size", async () => {
    const text = 'data: {"type":"ping"}\n\n: a comment\n\ndata: {"type":"job","job":\ndata: {"id":"ä"}}\n\n';
    const bytes = new TextEncoder().encode(text);
    for (const size of [1, 7, 64, bytes.length]) {
      const pieces = new ReadableStream<Uint8Array>({
        start(stream) {
          for (let i = 0; i < bytes.length; i += size) stream.enqueue(bytes.slice(i, i + size));
          stream.close();
        },
      });
      answering(() => new Response(pieces));
      const stop = new AbortController();
      const heard: api.Event[] = [];
      const told: boolean[] = [];
      await new Client("").events(
        (event) => {
          heard.push(event);
        },
        (there) => {
          told.push(there);
          if (!there) stop.abort();
        },
        stop.signal,
      );
      expect(heard).toEqual([{ type: "ping" }, { type: "job", job: { id: "ä" } }]);
      expect(told).toEqual([true, false]);
    }
  }, 20_000);
});
