// The switch for the colour scheme: a cookie keeps the choice, so that the next page has these colours at once.
const YEAR = 365 * 24 * 3600; // s
const group = document.querySelector("[data-schemes]");

group.hidden = false;
group.addEventListener("click", ({ target }) => {
  const scheme = target.dataset.schemeChoice;
  if (scheme === undefined) return;
  document.cookie = `scheme=${scheme}; path=/; max-age=${scheme ? YEAR : 0}; samesite=lax`;
  location.reload(); // plots and solids are drawn again in the new colours; drafts are kept
});
