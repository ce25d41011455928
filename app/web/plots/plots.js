// Plotly, loaded when the first plot is drawn, and what all plots have in common.
import { plain } from "../shared/numbers.js";

let loading;

export function plotly() {
  loading ??= new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = "/static/plotly.min.js";
    script.onload = () => resolve(window.Plotly);
    script.onerror = () => reject(new Error("the plots could not be loaded"));
    document.head.append(script);
  });
  return loading;
}

export const CONFIG = { displaylogo: false, responsive: true, displayModeBar: false };
export const COLOURS = ["#1b4f7f", "#b5651d", "#1d6b3a", "#8e2f6b", "#5a5f66", "#0f8a8a"];
const FAMILY = "Liberation Sans, Segoe UI, Arial, sans-serif";

// Return a colour of the page's scheme.
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

export function layout(more = {}) {
  const line = colour("rule-strong"), paper = colour("paper");
  const axis = { gridcolor: colour("rule"), zerolinecolor: line, automargin: true, linecolor: line, exponentformat: "e", minexponent: 5 };
  return {
    font: { family: FAMILY, size: 12, color: colour("ink") }, paper_bgcolor: paper, plot_bgcolor: paper, height: 300, colorway: COLOURS,
    margin: { l: 55, r: 15, t: 10, b: 45 }, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
    ...more,
    xaxis: { ...axis, ...more.xaxis }, yaxis: { ...axis, ...more.yaxis },
  };
}

// Draw a colour scale with its ends; Plotly's own scale would set style attributes.
export function scale(low, high, unit) {
  const bar = Object.assign(document.createElement("p"), { className: "colours" });
  for (const text of [plain(low), "", `${plain(high)} ${unit}`]) bar.append(Object.assign(document.createElement("span"), { textContent: text }));
  return bar;
}

export async function draw(place, traces, more) {
  const Plotly = await plotly();
  if (!place.isConnected) return;
  await Plotly.react(place, traces, layout(more), CONFIG);
}
