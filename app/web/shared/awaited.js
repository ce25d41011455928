// A page whose answer is still being calculated: follow its job, then show the result.
import { follow } from "./progress.js";
import { renewed } from "./renewed.js";

const place = document.querySelector("[data-progress]");
await follow(place.dataset.job, place, place.dataset.begins);
await renewed(place.querySelector("[data-progress-text]"));
