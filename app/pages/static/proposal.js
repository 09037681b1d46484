// The next experiment: computed when it is asked for, told in words, its command to download.

import { guarded, send } from "./api.js";

for (const form of document.querySelectorAll("form[data-propose]")) {
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const button = form.querySelector("button");
    guarded(button, form.querySelector("[role=alert]"), async () => {
      button.textContent = "Weighing runs…";
      try {
        const { data } = await send("GET", form.dataset.propose);
        tell(form.parentElement.querySelector(".found"), data);
        form.hidden = true;
      } finally {
        button.textContent = "Propose a run";
      }
    });
  });
}

function tell(place, run) {
  place.querySelector("[data-text]").textContent = run.text;
  place.querySelector("[data-facts]").replaceChildren(...facts(run).flatMap(([name, value]) => [made("dt", name), made("dd", value)]));
  place.hidden = false;
}

function facts(run) {
  const rows = [["Sampled at", `${run.sample_rate} Hz`]];
  if (run.separation !== null) rows.push(["Separation of the models by this run", `${run.separation.toPrecision(3)} standard deviations of the noise`]);
  if (run.so_far !== null) rows.push(["Separation by the runs so far", `${run.so_far.toPrecision(3)} standard deviations of the noise`]);
  rows.push(["Expected information gain", `${run.information.toPrecision(3)} nats`]);
  return rows;
}

function made(tag, text) {
  const element = document.createElement(tag);
  element.textContent = text;
  return element;
}
