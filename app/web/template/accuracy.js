// Speed against accuracy: every level at its cost, with the median and the largest of its measured errors.
import { call } from "../shared/api.js";
import { COLOURS, draw } from "../plots/plots.js";

const SHOWN = 5; // outputs

export async function drawAccuracy(place) {
  const { payload } = await call("GET", place.dataset.accuracy);
  const levels = Object.entries(payload.levels);
  const outputs = [...new Set(levels.flatMap(([, level]) => Object.keys(level.errors)))].slice(0, SHOWN);
  const lines = outputs.map((name, n) => {
    const points = levels.map(([level, { cost, errors }]) => ({ level, cost: cost.single * 1000, errors: sorted(errors[name]) })).filter((point) => point.errors.length);
    const middle = points.map(({ errors }) => errors[Math.floor(errors.length / 2)]);
    return {
      name: name.replaceAll("_", " "), x: points.map((point) => point.cost), y: middle, mode: "markers+lines",
      line: { width: 1, dash: "dot", color: COLOURS[n] }, marker: { size: 9, color: COLOURS[n] },
      text: points.map(({ level, errors }) => `${level}: largest ${(errors.at(-1) * 100).toPrecision(2)} %`), hovertemplate: "%{text}<br>median %{y:.2g}<extra>%{fullData.name}</extra>",
    };
  });
  const names = levels.map(([level, { cost }]) => ({ x: Math.log10(cost.single * 1000), y: 0, yref: "paper", yanchor: "bottom", text: level.replaceAll("_", " "), showarrow: false, textangle: -90, font: { size: 11 } }));
  await draw(place.querySelector(".drawing"), lines, {
    height: 340, annotations: names, xaxis: { type: "log", title: { text: "time of one point [ms]" } },
    yaxis: { type: "log", title: { text: "median relative error" }, minexponent: 2, dtick: 1 },
  });
}

const sorted = (table) => (table ?? []).flat(Infinity).filter((error) => typeof error === "number" && error > 0).sort((a, b) => a - b);
