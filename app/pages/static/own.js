// An effect of one's own: checked by the service, shown as mathematics or refused at a character, ranked or added.

import { guarded, send } from "./api.js";

const form = document.querySelector("form[data-own]");
const equation = form.elements.equation;
const at = form.querySelector(".at");
const shown = form.querySelector("[role=status]");

form.addEventListener("submit", (event) => {
  event.preventDefault();
  const button = event.submitter ?? form.querySelector("button");
  guarded(button, form.querySelector("[role=alert]"), () => submit(button.value));
});

async function submit(wish) {
  const custom = [definition()];
  await checked(custom[0]);
  if (wish === "rank") {
    await send("POST", "/api/v1/diagnoses", { fit: form.dataset.own, custom });
    location.hash = "missing";
    location.reload();
  } else if (wish === "add") {
    const { data } = await send("POST", `/api/v1/fits/${form.dataset.own}/effects`, { custom });
    location.assign(`/fits/${data.id}`);
  }
}

function definition() {
  const { name, place, meaning, equation: text, symbol, unit, lower, upper } = Object.fromEntries(new FormData(form));
  const strength = { symbol: symbol.trim(), unit: unit.trim(), lower: Number(lower), upper: Number(upper) };
  const lines = text.split("\n").filter((line) => line.trim());
  return { name: name.trim(), place, equation: lines.length > 1 ? lines : lines[0] ?? "", strength, ...(meaning.trim() && { meaning: meaning.trim() }) };
}

async function checked(wanted) {
  at.hidden = true;
  shown.replaceChildren();
  equation.removeAttribute("aria-invalid");
  try {
    const { data } = await send("POST", "/api/v1/custom-effects", wanted);
    shown.replaceChildren(...data.equations.map(formula));
  } catch (error) {
    point(error.problem?.where ?? "");
    throw error;
  }
}

// The service's MathML, which it makes of an equation that passed the grammar.
function formula({ mathml }) {
  return document.adoptNode(new DOMParser().parseFromString(mathml, "text/html").querySelector("math"));
}

// The line that is refused with its character marked, and the cursor there.
function point(where) {
  const found = /^equation(?:, line (\d+))?, character (\d+)/.exec(where);
  if (!found) return;
  const lines = equation.value.split("\n");
  const full = [...lines.keys()].filter((place) => lines[place].trim());
  const row = full[Number(found[1] ?? 1) - 1] ?? 0;
  const place = Math.min(Number(found[2]) - 1, lines[row].length);
  const mark = document.createElement("mark");
  mark.textContent = lines[row][place] ?? " ";
  at.replaceChildren(lines[row].slice(0, place), mark, lines[row].slice(place + 1));
  at.hidden = false;
  equation.setAttribute("aria-invalid", "true");
  equation.focus();
  const start = lines.slice(0, row).reduce((sum, line) => sum + line.length + 1, place);
  equation.setSelectionRange(start, start + 1);
}
