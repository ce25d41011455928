// A model's page: its part in three dimensions; asked for again while it is being built.
import { startSolids } from "./solids.js";

const AGAIN = 1500; // ms

startSolids(() => ({}));
if (document.querySelector("[data-again]")) setTimeout(() => location.reload(), AGAIN);
