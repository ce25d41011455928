// A model's page: its part in three dimensions, analysed by finite elements; asked for again while it is being built.
import { startDownloads } from "../shared/downloads.js";
import { startElements } from "../elements/elements.js";
import { startSolids } from "../solid/solids.js";

startDownloads();

const AGAIN = 1500; // ms

startSolids(() => ({}));
startElements();
if (document.querySelector("[data-again]")) setTimeout(() => location.reload(), AGAIN);
