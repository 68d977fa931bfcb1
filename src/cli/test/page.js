"use strict";
// Actual over expected in one frame: a slider cuts between them, a button blinks.
for (const pictures of document.querySelectorAll(".pictures")) {
  const source = (name) => pictures.querySelector(`[data-picture=${name}] img`);
  const [actual, expected] = [source("actual"), source("expected")];
  if (!actual || !expected) continue;
  const make = (tag, set, ...children) => {
    const element = Object.assign(document.createElement(tag), set);
    element.append(...children);
    return element;
  };
  const copy = (image) => make("img", { src: image.src, alt: image.alt, width: image.width, height: image.height });
  const [under, over] = [copy(expected), copy(actual)];
  const edge = make("div", { className: "edge" });
  const slider = make("input", { type: "range", min: 0, max: 100, value: 50, ariaLabel: "actual left, expected right" });
  const button = make("button", { type: "button", textContent: "Blink" });
  const shown = make("output", {});
  const show = (percent, words) => {
    over.style.clipPath = `inset(0 ${100 - percent}% 0 0)`;
    edge.style.left = `${percent}%`;
    edge.hidden = percent <= 0 || percent >= 100;
    shown.textContent = words;
  };
  let timer = 0;
  const cut = () => {
    clearInterval(timer);
    timer = 0;
    button.textContent = "Blink";
    show(Number(slider.value), "actual | expected");
  };
  button.addEventListener("click", () => {
    if (timer) return cut();
    let isActual = true;
    const blink = () => {
      show(isActual ? 100 : 0, isActual ? "actual" : "expected");
      isActual = !isActual;
    };
    blink();
    timer = setInterval(blink, 500);
    button.textContent = "Stop";
  });
  slider.addEventListener("input", cut);
  cut();
  const tools = make("div", { className: "tools" }, slider, button, shown);
  pictures.after(make("div", { className: "compare" }, make("div", { className: "frame" }, under, over, edge), tools));
}
