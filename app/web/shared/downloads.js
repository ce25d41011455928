// Downloads: wait for a file that must be created first, and never save a response that is not a file.
import { Refused, call } from "./api.js";
import { isolated } from "./isolated.js";
import { watched } from "./progress.js";

export function startDownloads() {
  startDownloadForms();
  for (const link of document.querySelectorAll("[data-download]")) {
    link.addEventListener("click", (event) => {
      if (event.ctrlKey || event.metaKey || event.shiftKey) return; // opened in another tab: leave it to the browser
      event.preventDefault();
      download(link);
    });
  }
}

// A form whose fields become part of a file's address, without the empty ones.
function startDownloadForms() {
  for (const form of document.querySelectorAll("[data-download-form]")) {
    form.addEventListener("submit", async (event) => {
      event.preventDefault();
      const typed = new URLSearchParams([...new FormData(form)].filter(([, text]) => text.trim()));
      const link = Object.assign(document.createElement("a"), { href: `${event.submitter.formAction}?${typed}` });
      form.querySelector("[data-buttons]").append(link);
      await download(link);
      link.remove();
    });
  }
}

async function download(link) {
  if (link.ariaBusy === "true") return;
  link.ariaBusy = "true";
  const status = statusOf(link);
  try {
    const answer = await fileOf(link.href, (progress, text) => status.replaceChildren(bar(progress), isolated(text)));
    save(await answer.blob(), nameIn(answer) ?? (link.download || link.pathname.split("/").pop()));
    status.textContent = "";
  } catch (error) {
    status.replaceChildren(isolated(error instanceof Refused ? error.message : "The file could not be downloaded; try again."));
  } finally {
    link.ariaBusy = "false";
  }
}

// Return the response with the file, after any job that must create it.
async function fileOf(path, say) {
  for (;;) {
    const answer = await fetch(path, { headers: { Prefer: "respond-async" } });
    const job = [202, 503].includes(answer.status) && answer.headers.get("Location");
    if (!job) {
      if (!answer.ok) throw new Refused(answer.status, await answer.json().catch(() => ({})));
      return answer;
    }
    say(0, "The file is being created …");
    await watched(job, say);
    const { payload } = await call("GET", job);
    if (payload.state !== "done") throw new Refused(payload.problem?.status ?? 409, payload.problem ?? { detail: "The job was cancelled." });
  }
}

function save(blob, name) {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000); // by then the browser has read it
}

function nameIn(answer) {
  const said = answer.headers.get("Content-Disposition") ?? "";
  const wide = said.match(/filename\*=UTF-8''([^;]+)/i), plain = said.match(/filename="([^"]+)"/);
  return wide ? decodeURIComponent(wide[1]) : plain?.[1];
}

// The place for the progress of a download: after the links.
function statusOf(link) {
  const shown = link.parentElement.querySelector("[data-download-status]");
  if (shown) return shown;
  const status = document.createElement("span");
  status.setAttribute("role", "status");
  status.dataset.downloadStatus = "";
  link.parentElement.append(status);
  return status;
}

const bar = (value) => Object.assign(document.createElement("progress"), { value });
