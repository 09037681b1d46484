// An effect of one's own: checked by the service, shown as mathematics or refused at a character, ranked, added or kept.

import { guarded, send } from "./api.js";

const form = document.querySelector("form[data-own]");
const equation = form.elements.equation;
const at = form.querySelector(".at");
const shown = form.querySelector(".formula");
const kept = form.querySelector("[data-kept]");
const rate = form.elements.rate;
let count = 0;

// Another parameter of the equation: its labels name its fields by a number of their own.
form.querySelector("[data-more]").addEventListener("click", () => {
  const row = form.querySelector("template[data-shape]").content.cloneNode(true).firstElementChild;
  count += 1;
  for (const field of row.querySelectorAll(".field")) {
    const input = field.querySelector("input");
    input.id = `own-${input.name}-${count}`;
    field.querySelector("label").htmlFor = input.id;
  }
  row.querySelector("[data-less]").addEventListener("click", () => {
    row.remove();
    form.querySelector("[data-more]").focus();
  });
  form.querySelector("[data-shapes]").append(row);
  row.querySelector("input").focus();
});

form.addEventListener("submit", (event) => {
  event.preventDefault();
  const button = event.submitter ?? form.querySelector("button");
  guarded(button, form.querySelector("[role=alert]"), () => submit(button.value));
});

async function submit(wish) {
  const custom = [definition()];
  kept.replaceChildren();
  await checked(custom[0]);
  if (wish === "rank") {
    await send("POST", "/api/v1/diagnoses", { fit: form.dataset.own, custom });
    location.hash = "missing";
    location.reload();
  } else if (wish === "add") {
    const { data } = await send("POST", `/api/v1/fits/${form.dataset.own}/effects`, { custom });
    location.assign(`/fits/${data.id}`);
  } else if (wish === "keep") {
    const { data } = await send("POST", "/api/v1/own-effects", { name: custom[0].name, definition: custom[0] });
    kept.textContent = `Saved as ${data.name}. Every fit with a suitable model now offers it.`;
  }
}

function definition() {
  const { name, place, meaning, equation: text, symbol, unit, lower, upper } = Object.fromEntries(new FormData(form));
  const strength = { symbol: symbol.trim(), unit: unit.trim(), lower: Number(lower), upper: Number(upper) };
  const lines = text.split("\n").filter((line) => line.trim());
  const made = { name: name.trim(), place, equation: lines.length > 1 ? lines : lines[0] ?? "", strength };
  const shape = shapes();
  if (shape.length) made.shape = shape;
  const curve = curveOf((name) => form.elements[name].value.trim());
  if (curve) made.curve = curve;
  const state = { symbol: form.elements.state.value.trim(), rate: rate.value.trim() };
  if (state.symbol || state.rate) made.state = state;
  if (meaning.trim()) made.meaning = meaning.trim();
  return made;
}

// Nothing where neither its symbol nor its knots are given; what is left out beside them the service asks for.
function curveOf(given) {
  if (!given("curve") && !given("knots")) return null;
  const listed = (name) => given(name).split(",").map((one) => one.trim()).filter(Boolean);
  const made = { symbol: given("curve"), of: given("of"), knots: listed("knots"), unit: given("curve-unit"), draw: given("draw") };
  made.values = listed("values").map(Number);
  for (const end of ["lower", "upper"]) if (given(`curve-${end}`)) made[end] = Number(given(`curve-${end}`));
  return made;
}

function shapes() {
  return [...form.querySelectorAll(".shape")].map((row) => {
    const of = (name) => row.querySelector(`[name=shape-${name}]`).value.trim();
    const [value, lower, upper] = ["value", "lower", "upper"].map((name) => Number(of(name)));
    return { symbol: of("symbol"), unit: of("unit"), value, lower, upper };
  });
}

async function checked(wanted) {
  at.hidden = true;
  shown.replaceChildren();
  for (const field of [equation, rate]) field.removeAttribute("aria-invalid");
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
  const ofRate = /^state rate, character (\d+)/.exec(where);
  if (ofRate) return mark(rate, rate.value.trim(), Number(ofRate[1]) - 1, rate.value.length - rate.value.trimStart().length);
  const found = /^equation(?:, line (\d+))?, character (\d+)/.exec(where);
  if (!found) return;
  const lines = equation.value.split("\n");
  const full = [...lines.keys()].filter((place) => lines[place].trim());
  const row = full[Number(found[1] ?? 1) - 1] ?? 0;
  mark(equation, lines[row], Number(found[2]) - 1, lines.slice(0, row).reduce((sum, line) => sum + line.length + 1, 0));
}

// `line` begins at `start` of the field; its character at `wanted` is at fault.
function mark(field, line, wanted, start) {
  const place = Math.max(0, Math.min(wanted, line.length));
  const fault = document.createElement("mark");
  fault.textContent = line[place] ?? " ";
  at.replaceChildren(line.slice(0, place), fault, line.slice(place + 1));
  at.hidden = false;
  field.setAttribute("aria-invalid", "true");
  field.focus();
  field.setSelectionRange(start + place, start + place + 1);
}
