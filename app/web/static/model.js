// A model's page: its part in three dimensions, analysed by finite elements; asked for again while it is being built.
import { startDownloads } from "./downloads.js";
import { startElements } from "./elements.js";
import { startSolids } from "./solids.js";

startDownloads();

const AGAIN = 1500; // ms

startSolids(() => ({}));
startElements();
if (document.querySelector("[data-again]")) setTimeout(() => location.reload(), AGAIN);
