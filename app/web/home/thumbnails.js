// Request a picture again while it is still being drawn.
const AGAIN = 2000, TIMES = 8; // ms

for (const image of document.querySelectorAll("img[data-thumbnail]")) {
  let tried = 0;
  const retry = () => {
    image.classList.add("missing");
    if (tried++ < TIMES) setTimeout(() => (image.src = `${image.src.split("?")[0]}?again=${tried}`), AGAIN);
  };
  image.addEventListener("error", retry);
  image.addEventListener("load", () => image.classList.remove("missing"));
  if (image.complete && image.naturalWidth === 0 && image.currentSrc) retry();
}
