// The steps of a long design: inputs and results of a folded one are fetched when it is opened.
import { isolated } from "./isolated.js";
import { units } from "./api.js";

let adopt = () => {}; // takes a step that has come into the page

export function startLater(form, take) {
  adopt = take;
  for (const fold of form.querySelectorAll("[data-later]")) fold.addEventListener("toggle", () => fold.open && fetched(fold));
}

// The fold of a step that is not in the page yet.
export const foldOf = (step) => document.querySelector(`[data-fold="${CSS.escape(step)}"][data-later]`);

// Fetch what a fold holds; twice asked, it is fetched once.
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
    const [, ...body] = page.querySelector("section.step > details").children; // behind its fold line
    link.replaceWith(...body);
    delete fold.dataset.later;
    adopt(fold);
  } catch (error) {
    link.querySelector("[role=alert]")?.remove();
    const words = Object.assign(document.createElement("span"), { className: "field-error" });
    words.setAttribute("role", "alert");
    words.append(isolated(`It could not be fetched: ${error.message}. Fold and open the step to try again.`));
    link.append(" ", words);
  }
}
