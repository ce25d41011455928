// How a job goes on: its events in the bar of the page; it can be cancelled there.
import { call } from "./api.js";

const ENDED = ["done", "failed", "cancelled"];

export function follow(path) {
  const place = document.querySelector("[data-progress]");
  const bar = place.querySelector("progress"), words = place.querySelector("[data-progress-text]");
  place.hidden = false;
  words.textContent = "The part is being built …";
  place.querySelector("form").onsubmit = (event) => {
    event.preventDefault();
    call("DELETE", path).catch(() => {}); // it has ended meanwhile
  };
  place.scrollIntoView({ block: "nearest" });
  return new Promise((ended) => {
    const events = new EventSource(`${path}/events`);
    events.addEventListener("progress", ({ data }) => {
      const { progress, text } = JSON.parse(data);
      bar.value = progress;
      words.textContent = text;
    });
    const end = () => {
      events.close();
      ended();
    };
    for (const state of ENDED) events.addEventListener(state, end);
    events.onerror = () => call("GET", path).then(({ told }) => ENDED.includes(told.state) && end(), () => {}); // it tries again
  });
}
