// Start the 3-D views of a page when they come into view, the choice of a field for their colours, and the switch for the film pressure.
import { isolated } from "../shared/isolated.js";
import { whenSeen } from "../plots/pictures.js";

export function startSolids(stepsNow) {
  for (const place of document.querySelectorAll("[data-solid]")) {
    const shown = new Promise((done) => whenSeen(place, async () => {
      const { showSolid } = await import("./solid.js");
      await showSolid(place);
      done();
    }));
    const section = place.closest("section");
    obey(section.querySelector("[data-field]"), shown, "The colours cannot be shown", async (choice) => {
      const { colourBy } = await import("./solid.js");
      await colourBy(place, choice.selectedOptions[0]);
    });
    obey(section.querySelector("[data-paint]"), shown, "The film pressure cannot be shown", async (box) => {
      const { paint } = await import("./solid.js");
      const picture = JSON.parse(place.dataset.painted), step = (await stepsNow())[picture.scope];
      if (!step?.outputs) throw new Error(`step ${picture.scope} has no results`);
      await paint(place, picture, { ...step.inputs, ...step.outputs }, box.checked);
    });
  }
}

// Act on each change of a control, one after another, once the part is shown; also on changes made before this script loaded.
function obey(control, shown, trouble, act) {
  if (!control) return;
  let last = shown;
  const next = () => {
    last = last.then(() => act(control)).then(() => tell(control, ""), (error) => tell(control, `${trouble}: ${error.message}`));
  };
  control.addEventListener("change", next);
  if (control.checked || control.selectedIndex > 0) next();
}

// Show an error below a control.
function tell(control, words) {
  const line = control.closest("p"), said = line.querySelector("[data-said]") ?? line.appendChild(Object.assign(document.createElement("span"), { role: "alert" }));
  said.dataset.said = "";
  said.replaceChildren(...(words ? [" ", isolated(words)] : []));
}
