// Connect the faces of a part with the parameters that they carry: a click on a face, or on a button of the list, shows where the
// dimension comes from. The list is the way without a mouse.
import { units } from "../shared/api.js";
import { isolated } from "../shared/isolated.js";

const NOT_MARKED = "This face carries no parameter of its own.";
const STILL = 4; // px
const PICKED = 60; // time in which Plotly finds the point under the pointer [ms]
const words = (name) => name.replaceAll("_", " ");

// Offer the parameters of a drawn part. `bodies` are those of the figure, in the order of its traces, with the parameters of each
// corner in `marks`; `highlight` colours the faces that carry a parameter.
export function startFaces(place, figure, bodies, highlight) {
  const fold = place.closest("section")?.querySelector("[data-faces]");
  const names = [...new Set(bodies.flatMap(({ marks }) => marks.flat()))].sort();
  if (!fold || !names.length) return;
  fold.drawn = { bodies, highlight };
  if (!fold.hidden) return chosenAgain(fold);
  fold.hidden = false;
  fold.querySelector("[data-face-list]").replaceChildren(...names.flatMap((name) => [button(fold, name), " "]));
  watchClicks(figure, (point) => clicked(fold, point));
}

// Call `act` with the point under the pointer if it is pressed and released without moving. Plotly's own click event also comes
// with every frame of a drag, which turns the part.
function watchClicks(figure, act) {
  let under, down;
  for (const event of ["plotly_hover", "plotly_click"]) figure.on?.(event, ({ points: [point] }) => (under = point));
  figure.on?.("plotly_unhover", () => (under = undefined));
  figure.addEventListener("pointerdown", ({ clientX, clientY }) => (down = [clientX, clientY]), true);
  figure.addEventListener("pointerup", ({ clientX, clientY }) => {
    const isStill = down && Math.hypot(clientX - down[0], clientY - down[1]) < STILL;
    down = undefined;
    if (isStill) setTimeout(() => under && act(under), PICKED);
  }, true);
}

function button(fold, name) {
  const one = Object.assign(document.createElement("button"), { type: "button", textContent: words(name) });
  one.dataset.parameter = name;
  one.setAttribute("aria-pressed", "false");
  one.addEventListener("click", () => choose(fold, one.getAttribute("aria-pressed") === "true" ? undefined : name));
  return one;
}

// The corners of a body repeat for each of its instances; traces behind the bodies, such as the film pressure, are no faces.
function clicked(fold, { curveNumber, pointNumber }) {
  const marks = fold.drawn.bodies[curveNumber]?.marks;
  if (!marks) return;
  const [name, ...others] = marks[pointNumber % marks.length], panel = fold.querySelector("[data-face-panel]");
  fold.open = true;
  choose(fold, name, others);
  if (!name) panel.textContent = NOT_MARKED;
  panel.scrollIntoView({ block: "nearest" });
}

function chosenAgain(fold) {
  const chosen = fold.querySelector("[aria-pressed=true]");
  if (chosen) fold.drawn.highlight(chosen.dataset.parameter);
}

// Show where a parameter comes from, and highlight its faces; an answer that a later choice has overtaken is dropped. A face
// may carry other parameters as well.
async function choose(fold, name, others = []) {
  const turn = (fold.turn = (fold.turn ?? 0) + 1), panel = fold.querySelector("[data-face-panel]");
  for (const one of fold.querySelectorAll("[data-parameter]")) one.setAttribute("aria-pressed", String(one.dataset.parameter === name));
  panel.replaceChildren();
  panel.setAttribute("aria-busy", String(name !== undefined));
  try {
    await fold.drawn.highlight(name);
    const article = name === undefined ? [] : [await fetched(fold.dataset.faces + name)];
    if (turn === fold.turn && article.length) panel.replaceChildren(...article, ...alsoCarried(fold, others));
  } catch (error) {
    if (turn === fold.turn) panel.replaceChildren(trouble(error));
  } finally {
    if (turn === fold.turn) panel.setAttribute("aria-busy", "false");
  }
}

function alsoCarried(fold, names) {
  if (!names.length) return [];
  const line = Object.assign(document.createElement("p"), { className: "face-list", textContent: "This face also carries" });
  line.append(...names.map((name) => button(fold, name)));
  return [line];
}

async function fetched(path) {
  const answer = await fetch(`${path}?units=${units()}`);
  if (!answer.ok) throw new Error(`answer ${answer.status}`);
  const article = new DOMParser().parseFromString(await answer.text(), "text/html").querySelector("article.face");
  if (!article) throw new Error("the service sent another page; sign in again");
  return article;
}

function trouble(error) {
  const line = Object.assign(document.createElement("p"), { className: "field-error" });
  line.setAttribute("role", "alert");
  line.append(isolated(`The origin of this dimension could not be loaded: ${error.message}`));
  return line;
}
