// The page of a solution that is still calculated: follows its job, then shows what came of it.
import { follow } from "./progress.js";

const place = document.querySelector("[data-progress]");
await follow(place.dataset.job, place, "The design is being solved …");
location.reload();
