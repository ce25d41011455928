// Starts the 3-D views of a page when they come into view, the choice of a field that colours them, and the switch that paints the film pressure.
import { whenSeen } from "./pictures.js";

export function startSolids(stepsNow) {
  for (const place of document.querySelectorAll("[data-solid]")) {
    const shown = new Promise((done) => whenSeen(place, async () => {
      const { showSolid } = await import("./solid.js");
      await showSolid(place);
      done();
    }));
    const choice = place.closest("section").querySelector("[data-field]");
    choice?.addEventListener("change", async () => {
      await shown;
      const { colourBy } = await import("./solid.js");
      await colourBy(place, choice.selectedOptions[0]);
    });
    const box = place.closest("section").querySelector("[data-paint]");
    box?.addEventListener("change", async () => {
      await shown;
      const { paint } = await import("./solid.js");
      const picture = JSON.parse(place.dataset.painted), step = stepsNow()[picture.scope];
      await paint(place, picture, { ...step.inputs, ...step.outputs }, box.checked);
    });
  }
}
