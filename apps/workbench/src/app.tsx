// The page: a bar at the top, the 3D view on the left, panels on the right.
import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { EditPanel } from "./edit/panel";
import { keep, kept } from "./keep";
import { AttributesPanel } from "./panels/attributes";
import { BuildingsPanel } from "./panels/buildings";
import { ComparePanel } from "./panels/compare_panel";
import { HelpSheet, pressed } from "./panels/help";
import { LayersTab } from "./panels/layers_tab";
import { Messages } from "./panels/messages";
import { PlotsPanel } from "./panels/plots_panel";
import { Progress } from "./panels/progress";
import { ReasonsStrip } from "./panels/reasons_strip";
import { RunPanel } from "./panels/run";
import { Start, changeInputs, take } from "./panels/start";
import { Steps } from "./panels/steps";
import { TopBar } from "./panels/topbar";
import { ReviewPanel } from "./review/panel";
import * as state from "./state";
import { View } from "./view/view";

const tabs: { tab: state.Tab; name: string }[] = [
  { tab: "edit", name: "Edit" },
  { tab: "run", name: "Run" },
  { tab: "buildings", name: "Buildings" },
  { tab: "review", name: "Review" },
  { tab: "attributes", name: "Attributes" },
  { tab: "plots", name: "Plots" },
  { tab: "layers", name: "Layers" },
];

const dropping = signal(false);
const [minimumWidth, maximumWidth] = [340, 760];
const width = signal(Math.max(minimumWidth, Math.min(maximumWidth, kept("local", "sidebar", 440))));

export function App() {
  useEffect(() => {
    const listen = (e: KeyboardEvent) => pressed(e);
    window.addEventListener("keydown", listen);
    return () => window.removeEventListener("keydown", listen);
  }, []);
  const project = state.project.value;
  const empty = project !== null && !project.inputs && !project.runs.length;
  return (
    <div class="page" style={{ "--sidebar": `${width.value}px` }}>
      <TopBar />
      {empty ? (
        <main class="alone">
          <Start />
        </main>
      ) : (
        <>
          <main
            onDragOver={(e) => {
              if (!e.dataTransfer?.types.includes("Files")) return;
              e.preventDefault();
              dropping.value = true;
            }}
            onDragLeave={(e) => {
              if (!e.currentTarget.contains(e.relatedTarget as Node | null)) dropping.value = false;
            }}
            onDrop={(e) => {
              e.preventDefault();
              dropping.value = false;
              const files = [...(e.dataTransfer?.files ?? [])];
              if (!files.length || state.changingInputs.value) return;
              changeInputs();
              void take(files);
            }}
          >
            <View />
            {dropping.value && (
              <div class="dropping">
                <p>Drop mesh, footprints or terrain to use them as inputs</p>
              </div>
            )}
            <Steps />
            {state.changingInputs.value && <Start />}
            {state.opening.value && <div class="opening">Opening {state.opening.value} …</div>}
            {state.busyJob.value && state.tab.value !== "run" && (
              <div class="busy">
                <Progress job={state.busyJob.value} />
              </div>
            )}
          </main>
          <aside aria-label="Panels">
            <Splitter />
            <Tabs />
            <ReasonsStrip />
            <Panel />
          </aside>
        </>
      )}
      <Messages />
      {state.keyboardHelp.value && <HelpSheet />}
    </div>
  );
}

function Tabs() {
  const all = state.other.value ? [...tabs, { tab: "compare" as const, name: "Compare" }] : tabs;
  const now = state.tab.value === "compare" && !state.other.value ? "run" : state.tab.value;
  const step = (e: KeyboardEvent) => {
    const direction = { ArrowRight: 1, ArrowLeft: -1 }[e.key];
    if (!direction) return;
    e.preventDefault();
    const at = all.findIndex((t) => t.tab === now);
    const next = all[(at + direction + all.length) % all.length]!;
    state.tab.value = next.tab;
    document.getElementById(`tab-${next.tab}`)?.focus();
  };
  return (
    <div class="tabs" role="tablist" aria-label="Panels" onKeyDown={step}>
      {all.map(({ tab, name }) => (
        <button
          key={tab}
          type="button"
          role="tab"
          id={`tab-${tab}`}
          aria-selected={now === tab}
          aria-controls="panel"
          tabIndex={now === tab ? 0 : -1}
          onClick={() => (state.tab.value = tab)}
        >
          {name}
        </button>
      ))}
    </div>
  );
}

function Panel() {
  const tab = state.tab.value;
  return (
    <div class={`tab-panel ${tab}`} role="tabpanel" id="panel" aria-labelledby={`tab-${tab}`}>
      {tab === "edit" && <EditPanel />}
      {tab === "run" && <RunPanel />}
      {tab === "buildings" && <BuildingsPanel />}
      {tab === "review" && <ReviewPanel />}
      {tab === "attributes" && <AttributesPanel />}
      {tab === "plots" && <PlotsPanel />}
      {tab === "layers" && <LayersTab />}
      {tab === "compare" && (state.other.value ? <ComparePanel /> : <RunPanel />)}
    </div>
  );
}

function Splitter() {
  const set = (w: number) => {
    width.value = Math.max(minimumWidth, Math.min(maximumWidth, Math.round(w), window.innerWidth - 320));
    keep("local", "sidebar", width.value);
  };
  return (
    <div
      class="splitter"
      role="separator"
      aria-orientation="vertical"
      aria-label="Width of the panels"
      aria-valuenow={width.value}
      aria-valuemin={minimumWidth}
      aria-valuemax={maximumWidth}
      tabIndex={0}
      onPointerDown={(e) => e.currentTarget.setPointerCapture(e.pointerId)}
      onPointerMove={(e) => {
        if (e.currentTarget.hasPointerCapture(e.pointerId)) set(window.innerWidth - e.clientX - 3);
      }}
      onKeyDown={(e) => {
        const direction = { ArrowLeft: 20, ArrowRight: -20 }[e.key];
        if (!direction) return;
        e.preventDefault();
        set(width.value + direction);
      }}
    />
  );
}
