// A page whose answer is still calculated: follows its job, then shows what came of it.
import { follow } from "./progress.js";
import { renewed } from "./renewed.js";

const place = document.querySelector("[data-progress]");
await follow(place.dataset.job, place, place.dataset.begins);
await renewed(place.querySelector("[data-progress-text]"));
