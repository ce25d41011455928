// Draw the pictures of a calculation, each kind by its own function; app/reports/pictures.py chooses them.
import { showClearance } from "./clearance.js";
import { unit } from "../shared/numbers.js";
import { draw } from "./plots.js";
import { drawPressure } from "./pressure.js";
import { showCrankStar } from "./crank_star.js";

const words = (name) => name.replaceAll("_", " ");
const named = (name, quantity) => (unit(quantity.unit) ? `${words(name)} [${unit(quantity.unit)}]` : words(name));

const KINDS = {
  clearance: showClearance,
  pressure: drawPressure,
  star: showCrankStar,

  curves(place, picture, values) {
    const x = values[picture.x], lines = picture.y.map((name) => ({ x: x.value, y: values[name].value, name: words(name), mode: "lines" }));
    const measured = unit(values[picture.y[0]].unit);
    const only = picture.y.length === 1 ? named(picture.y[0], values[picture.y[0]]) : measured && `[${measured}]`;
    return draw(place, lines, { showlegend: lines.length > 1, xaxis: { title: { text: named(picture.x, x) } }, yaxis: { title: { text: only } } });
  },

  rows(place, picture, values) {
    const x = values[picture.x], y = values[picture.y];
    const lines = picture.rows.map((row) => ({ x: x.value, y: y.value[row - 1], name: `no. ${row}`, mode: "lines" }));
    return draw(place, lines, { showlegend: true, xaxis: { title: { text: named(picture.x, x) } }, yaxis: { title: { text: named(picture.y, y) } } });
  },

  polar(place, picture, values) {
    const { x, y } = { x: values[picture.x], y: values[picture.y] };
    return square(place, [closed(x.value, y.value)], [named(picture.x, x), named(picture.y, y)]);
  },

  orbit(place, picture, values) {
    const x = values[picture.x], y = values[picture.y];
    const clearance = values[picture.clearance];
    const radius = x.unit === "1" ? 1 : clearance?.unit === x.unit ? clearance.value / 2 : largest(x.value, y.value);
    return square(place, [closed(x.value, y.value), circle(radius)], [named(picture.x, x), named(picture.y, y)]);
  },

  campbell(place, picture, values) {
    const frequencies = values[picture.frequencies].value.filter((f) => f > 1e-9), orders = values[picture.orders].value;
    const fastest = values[picture.range]?.value?.at(-1), highest = Math.max(...frequencies);
    const rpm = fastest ?? (60 * highest) / Math.min(...orders);
    const top = 1.15 * Math.max(frequencies[0], Math.min(highest, (Math.max(...orders) * rpm) / 60));
    const modes = frequencies.map((f, n) => ({ x: [0, rpm], y: [f, f], mode: "lines", name: `mode ${n + 1}`, line: { width: 2 } }));
    const rays = orders.map((order) => ({ x: [0, rpm], y: [0, (order * rpm) / 60], mode: "lines", name: `order ${order}`, line: { dash: "dot", width: 1, color: "#51606f" } }));
    return draw(place, [...modes, ...rays], { xaxis: { title: { text: "speed [rpm]" } }, yaxis: { title: { text: "frequency [Hz]" }, range: [0, top] } });
  },

  modes(place, picture, values) {
    const frequencies = values[picture.frequencies].value;
    const lines = values[picture.shapes].value.map((shape, n) => ({ y: shape, x: shape.map((_, place) => place + 1), name: `${frequencies[n].toPrecision(4)} Hz`, mode: "lines+markers" }));
    return draw(place, lines, { xaxis: { title: { text: "inertia" }, dtick: 1 }, yaxis: { title: { text: "amplitude" } } });
  },
};

const closed = (x, y) => ({ x: [...x, x[0]], y: [...y, y[0]], mode: "lines", showlegend: false });
const largest = (x, y) => Math.max(...x.map((value, place) => Math.hypot(value, y[place])));

function circle(radius) {
  const angles = Array.from({ length: 121 }, (_, n) => (n * Math.PI) / 60);
  const line = { color: "#51606f", width: 1, dash: "dash" };
  return { x: angles.map((a) => radius * Math.cos(a)), y: angles.map((a) => radius * Math.sin(a)), mode: "lines", line, showlegend: false, hoverinfo: "skip" };
}

function square(place, traces, [x, y]) {
  return draw(place, traces, { height: 380, xaxis: { title: { text: x } }, yaxis: { title: { text: y }, scaleanchor: "x" } });
}

// Draw all pictures within an element once they are in view; `scope` is the step that `answer` belongs to.
export function drawPictures(root, scope, answer) {
  const values = { ...answer.inputs, ...answer.outputs };
  for (const figure of root.querySelectorAll("[data-picture]")) {
    const picture = JSON.parse(figure.dataset.picture);
    if (picture.scope === scope) whenSeen(figure, () => attempt(figure.querySelector(".drawing"), picture, values));
  }
}

async function attempt(place, picture, values) {
  try {
    await KINDS[picture.kind](place, picture, values);
  } catch (error) {
    place.textContent = `This picture could not be drawn: ${error.message}`;
  }
}

const waiting = new Map();
const observer = new IntersectionObserver((seen) => {
  for (const { target, isIntersecting } of seen) {
    if (!isIntersecting) continue;
    waiting.get(target)();
    observer.unobserve(target);
    waiting.delete(target);
  }
}, { rootMargin: "200px" });

export function whenSeen(element, then) {
  waiting.set(element, then);
  observer.unobserve(element);
  observer.observe(element);
}
