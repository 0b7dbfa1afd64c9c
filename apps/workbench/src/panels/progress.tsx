// A running job: its stage, progress and duration, and a button to cancel it.
import { useEffect, useState } from "preact/hooks";
import { cancelJob } from "../actions";
import type { Job } from "../api/types";
import { seconds } from "./words";

const seen = new Map<string, number>(); // when this page first received a running job

export function Progress({ job }: { job: Job }) {
  const [now, setNow] = useState(Date.now());
  useEffect(() => {
    const clock = setInterval(() => setNow(Date.now()), 500);
    return () => clearInterval(clock);
  }, []);
  if (job.state === "running" && !seen.has(job.id)) seen.set(job.id, now);
  const since = seen.get(job.id);
  const what = { read: "Reading inputs", run: `Reconstructing ${job.run ?? ""}`, textures: "Reading textures" }[job.kind];
  const where = [job.stage, job.subject].filter(Boolean).join(" · ");
  return (
    <div class="progress" role="status" aria-live="polite">
      <div class="progress-words">
        <b>{what}</b>
        <span>{job.state === "queued" ? "waiting" : where}</span>
        <span class="number">
          {Math.round(job.fraction * 100)} %{since !== undefined && ` · ${seconds((now - since) / 1000)}`}
        </span>
        <button type="button" class="small" onClick={() => void cancelJob(job.id)}>
          Cancel
        </button>
      </div>
      <progress value={job.fraction} max={1} aria-label={what} />
    </div>
  );
}
