// The steps of a long design: inputs and results of a folded step are loaded when it is opened.
import { isolated } from "./isolated.js";
import { units } from "./api.js";

let adopt = () => {}; // sets up a step that was loaded into the page

export function startLater(form, take) {
  adopt = take;
  for (const fold of form.querySelectorAll("[data-later]")) fold.addEventListener("toggle", () => fold.open && fetched(fold));
}

// Return the fold of a step that is not loaded yet.
export const foldOf = (step) => document.querySelector(`[data-fold="${CSS.escape(step)}"][data-later]`);

// Load the content of a fold, only once even if it is requested twice.
export function fetched(fold) {
  if (fold.dataset.later === undefined) return Promise.resolve();
  return (fold.coming ??= filled(fold).finally(() => delete fold.coming));
}

async function filled(fold) {
  const link = fold.querySelector("[data-later-link]");
  try {
    const answer = await fetch(`${fold.dataset.later}&units=${units()}`);
    if (!answer.ok) throw new Error(`answer ${answer.status}`);
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    const [, ...body] = page.querySelector("section.step > details").children; // after its summary line
    link.replaceWith(...body);
    delete fold.dataset.later;
    adopt(fold);
  } catch (error) {
    link.querySelector("[role=alert]")?.remove();
    const words = Object.assign(document.createElement("span"), { className: "field-error" });
    words.setAttribute("role", "alert");
    words.append(isolated(`The step could not be loaded: ${error.message}. Fold and open the step to try again.`));
    link.append(" ", words);
  }
}
