// What the error of a fit is made of, as one bar: computed by the service from the samples.

import { send } from "./api.js";
import { percent } from "./words.js";

const figure = document.querySelector("[data-budget]");
const PARTS = {
  noise: "measurement noise",
  linear: "linear model error (a better linear model would remove it)",
  nonlinear: "nonlinear model error (only a nonlinear model would remove it)",
};

try {
  const { data } = await send("GET", figure.dataset.budget);
  if (data) draw(data);
} catch {
  figure.remove(); // a model without a linear core has no budget; the errors above stand by themselves
}

function draw(budget) {
  const shown = Object.entries(PARTS).filter(([name]) => budget[name] !== null);
  const whole = shown.reduce((sum, [name]) => sum + budget[name] ** 2, 0);
  let from = 0;
  for (const [name, meaning] of shown) {
    const share = whole ? (100 * budget[name] ** 2) / whole : 0;
    figure.querySelector("svg").append(bar(name, from, share));
    figure.querySelector("ul").append(entry(name, `${percent(share / 100)} ${meaning}, error ${percent(budget[name])}`));
    from += share;
  }
  const notes = figure.querySelector("details");
  notes.hidden = !budget.notes.length;
  for (const note of budget.notes) notes.querySelector("ul").append(entry("", note));
  figure.hidden = false;
}

function bar(name, x, width) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  for (const [key, value] of Object.entries({ class: name, x, width, height: 12 })) made.setAttribute(key, value);
  return made;
}

function entry(name, text) {
  const made = document.createElement("li");
  if (name) made.className = name;
  made.textContent = text;
  return made;
}
