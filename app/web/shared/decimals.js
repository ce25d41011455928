// The switch for the decimal sign of what users type: a cookie keeps the choice; without one, the language decides.
const YEAR = 365 * 24 * 3600; // s
const OF_LANGUAGE = new Intl.NumberFormat(navigator.language).format(0.5).includes(",") ? "comma" : "point";
const chosen = () => document.cookie.match(/(?:^|; )decimal=(comma|point)/)?.[1] ?? OF_LANGUAGE;

export const hasComma = () => chosen() === "comma";

const group = document.querySelector("[data-decimals]");

function show() {
  for (const button of group.querySelectorAll("button")) button.ariaPressed = String(button.dataset.decimalChoice === chosen());
}

group?.addEventListener("click", ({ target: { dataset } }) => {
  if (!dataset.decimalChoice) return;
  document.cookie = `decimal=${dataset.decimalChoice}; path=/; max-age=${YEAR}; samesite=lax`;
  show(); // the next text is read this way; nothing typed is lost
});

if (group) {
  group.hidden = false;
  show();
}
