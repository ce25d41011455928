// Starts the 3-D views of a page when they come into view, the choice of a field that colours them, and the switch that paints the film pressure.
import { isolated } from "./isolated.js";
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
      try {
        await colourBy(place, choice.selectedOptions[0]);
        tell(choice, "");
      } catch (error) {
        tell(choice, `The colours cannot be shown: ${error.message}`);
      }
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

// What went wrong, below a choice.
function tell(choice, words) {
  const line = choice.closest("p"), said = line.querySelector("[data-said]") ?? line.appendChild(Object.assign(document.createElement("span"), { role: "alert" }));
  said.dataset.said = "";
  said.replaceChildren(...(words ? [" ", isolated(words)] : []));
}
