// Follow a long calculation, which is a job: progress, cancellation, answer. Typing or leaving the page also cancels it.
import { call } from "./api.js";
import { follow } from "./progress.js";

export async function calculated(job, signal, progress = document.querySelector("[data-progress]")) {
  const stop = () => fetch(job, { method: "DELETE", keepalive: true }).catch(() => {}); // the job may have ended meanwhile
  if (signal?.aborted) stop();
  signal?.addEventListener("abort", stop);
  addEventListener("pagehide", stop);
  await follow(job, progress, "Calculating …");
  signal?.removeEventListener("abort", stop);
  removeEventListener("pagehide", stop);
  if (signal?.aborted) throw new DOMException("a newer request replaced it", "AbortError");
  progress.hidden = true;
  return call("GET", job.replace("/jobs/", "/evaluations/"));
}
