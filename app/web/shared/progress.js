// Show the progress of a job in a bar on the page, where it can be cancelled.
import { call } from "./api.js";
import { isolated } from "./isolated.js";

const ENDED = ["done", "failed", "cancelled"];

export function follow(path, place = document.querySelector("[data-progress]"), begins = "The design is being regenerated …") {
  const bar = place.querySelector("progress"), words = place.querySelector("[data-progress-text]");
  place.hidden = false;
  bar.value = 0;
  words.textContent = begins;
  place.querySelector("[data-cancel]").onclick = (event) => {
    event.preventDefault(); // without this script it is the button of a form
    call("DELETE", path).catch(() => {}); // the job may have ended meanwhile
  };
  place.scrollIntoView({ block: "nearest" });
  return watched(path, (progress, text) => {
    bar.value = progress;
    words.replaceChildren(isolated(text));
  });
}

// Wait until a job has ended, whatever its outcome; `say` receives its progress.
export function watched(path, say) {
  return new Promise((ended) => {
    const events = new EventSource(`${path}/events`);
    events.addEventListener("progress", ({ data }) => {
      const { progress, text } = JSON.parse(data);
      say(progress, text);
    });
    const end = () => {
      events.close();
      ended();
    };
    for (const state of ENDED) events.addEventListener(state, end);
    events.onerror = () => call("GET", path).then(({ payload }) => ENDED.includes(payload.state) && end(), () => {}); // the browser reconnects by itself
  });
}
