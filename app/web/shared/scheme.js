// The switch of colours: the choice is kept in a cookie, so that the next page comes in its colours at once.
const YEAR = 365 * 24 * 3600; // s
const group = document.querySelector("[data-schemes]");

group.hidden = false;
group.addEventListener("click", ({ target }) => {
  const scheme = target.dataset.schemeChoice;
  if (scheme === undefined) return;
  document.cookie = `scheme=${scheme}; path=/; max-age=${scheme ? YEAR : 0}; samesite=lax`;
  location.reload(); // plots and solids are drawn again in the new colours; drafts are kept
});
