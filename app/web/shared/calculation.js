// What takes long is a job: how far it is, a way to stop it, and its answer. Who types or leaves stops it as well.
import { call } from "./api.js";
import { follow } from "./progress.js";

export async function calculated(job, signal, progress = document.querySelector("[data-progress]")) {
  const stop = () => fetch(job, { method: "DELETE", keepalive: true }).catch(() => {}); // it has ended meanwhile
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
