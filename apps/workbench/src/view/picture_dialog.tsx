// A picture of the view as a file, and a link to it.
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as actions from "../actions";
import { Icon } from "../panels/icons";
import * as state from "../state";
import { viewer } from "./current";
import { attribution } from "./furniture";
import { address } from "./link";

const width = signal(1920);
const height = signal(1080);
const link = signal("");
const sizes = [
  [1280, 720],
  [1920, 1080],
  [3840, 2160],
] as const;

export function PictureDialog() {
  const first = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    link.value = "";
    first.current?.focus();
  }, []);
  const most = viewer.value?.largestPicture ?? 4096;
  const valid = (n: number) => Number.isInteger(n) && n >= 16 && n <= most;
  const save = async () => {
    const bytes = await viewer.value?.picture(width.value, height.value, attribution());
    if (!bytes) return actions.showMessage({ severity: "error", code: "picture", message: "the browser could not make the picture; choose a smaller size", subject: "" });
    const name = state.selection.value?.building ?? state.run.value?.id ?? "view";
    actions.offer(bytes, `${name.replace(/[^\w.-]+/g, "_")}.png`);
  };
  const share = async () => {
    link.value = address();
    if (await actions.copy(link.value)) actions.showSuccess("link-copied", "the link was copied; it restores this view in a page of this project");
  };
  return (
    <div class="popover picture-popover" role="dialog" aria-label="Picture and link">
      <header>
        <h2>Picture and link</h2>
        <button type="button" class="plain" aria-label="Close" onClick={() => (state.pictureOpen.value = false)}>
          <Icon name="close" />
        </button>
      </header>
      <div class="inline">
        {sizes.map(([w, h]) => (
          <button type="button" key={w} class="small" aria-pressed={width.value === w && height.value === h} onClick={() => ((width.value = w), (height.value = h))}>
            {w} × {h}
          </button>
        ))}
      </div>
      <div class="two">
        {([["Width, pixels", width], ["Height, pixels", height]] as const).map(([name, of]) => (
          <label class="field" key={name}>
            {name}
            <input type="text" inputMode="numeric" value={String(of.value)} aria-invalid={!valid(of.value)} onInput={(e) => (of.value = Number(e.currentTarget.value))} />
          </label>
        ))}
      </div>
      <p>
        <button ref={first} type="button" class="primary" disabled={!valid(width.value) || !valid(height.value)} onClick={() => void save()}>
          Save PNG
        </button>{" "}
        {(!valid(width.value) || !valid(height.value)) && <span class="wrong">16 to {most} pixels</span>}
      </p>
      <hr />
      <p>
        <button type="button" onClick={() => void share()}>
          Copy link
        </button>
      </p>
      {link.value && (
        <label class="field">
          Link to this view
          <input type="text" readOnly value={link.value} onFocus={(e) => e.currentTarget.select()} />
        </label>
      )}
      <p class="quiet">
        The link restores run, selection, camera, layers and colours. It has no access token: open it in a browser in
        which this project is open.
      </p>
    </div>
  );
}
