// Draw the pictures of a revision from the answer of the interface.
import { call, units } from "../shared/api.js";
import { startDownloads } from "../shared/downloads.js";
import { drawPictures } from "../plots/pictures.js";

startDownloads();

const [, id, number] = location.pathname.match(/designs\/([^/]+)\/revisions\/(\d+)/);
const { payload } = await call("GET", `/api/v1/designs/${id}/revisions/${number}/worksheet?units=${units()}`);
for (const [step, answer] of Object.entries(payload.steps)) drawPictures(document, step, answer);
