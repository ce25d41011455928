// The script of a model's page: 3-D view and finite elements; it reloads the page while the model is being built.
import { startDownloads } from "../shared/downloads.js";
import { startElements } from "../elements/elements.js";
import { startSolids } from "../solid/solids.js";

startDownloads();

const AGAIN = 1500; // ms

startSolids(() => ({}));
startElements();
if (document.querySelector("[data-again]")) setTimeout(() => location.reload(), AGAIN);
