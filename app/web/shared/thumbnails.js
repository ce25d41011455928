// Request a picture again while it is still being drawn; also a picture that a script adds to the page later.
const AGAIN = 2000, TIMES = 8; // ms
const tried = new WeakMap();

document.addEventListener("error", ({ target }) => retry(target), true); // these events do not bubble
document.addEventListener("load", ({ target }) => target.classList?.remove("missing"), true);
for (const image of document.images) {
  if (image.complete && image.naturalWidth === 0 && image.currentSrc) retry(image);
}

function retry(image) {
  if (!image.matches?.("img[data-thumbnail]")) return;
  const times = tried.get(image) ?? 0;
  image.classList.add("missing");
  tried.set(image, times + 1);
  if (times < TIMES) setTimeout(() => image.setAttribute("src", image.getAttribute("src")), AGAIN);
}
