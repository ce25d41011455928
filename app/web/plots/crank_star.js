// The crankpins of an engine seen from its flywheel; app/reports/crank_star.py draws the same in a report.
const SPACE = "http://www.w3.org/2000/svg", SIZE = 120, RAY = 74, WORDS = 98, SAME = 0.05;

export function showCrankStar(place, picture, values) {
  const star = make("svg", { viewBox: `${-SIZE} ${-SIZE} ${2 * SIZE} ${2 * SIZE}`, role: "img", "font-size": 12, "text-anchor": "middle" });
  const merged = rays(values[picture.angles].value);
  const words = merged.map(([angle, names]) => `${names.join(" and ")} at ${Math.round(10 * angle) / 10}°`);
  star.setAttribute("aria-label", `Crankpins seen from the flywheel: ${words.join(", ")}`);
  star.append(make("circle", { r: RAY, class: "reach" }), make("path", { d: "M20,-22a30,30 0 0,0 -40,0m1,-7l-2,8l8,1", class: "turning" }));
  for (const [angle, names] of merged) {
    const left = Math.sin((angle * Math.PI) / 180), up = Math.cos((angle * Math.PI) / 180);
    const name = make("text", { x: -WORDS * left, y: 4 - WORDS * up });
    name.textContent = names.join(", ");
    star.append(make("path", { d: `M0,0L${-RAY * left},${-RAY * up}`, class: "web" }), make("circle", { cx: -RAY * left, cy: -RAY * up, r: 9, class: "pin" }), name);
  }
  star.append(make("circle", { r: 7, class: "shaft" }));
  place.replaceChildren(star);
}

function rays(angles) {
  const merged = [];
  angles.forEach((angle, place) => {
    const same = merged.find(([at]) => Math.abs(wrapped(angle - at + 180) - 180) < SAME);
    if (same) same[1].push(place + 1);
    else merged.push([wrapped(angle), [place + 1]]);
  });
  return merged;
}

const wrapped = (angle) => ((angle % 360) + 360) % 360;

function make(name, attributes) {
  const element = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}
