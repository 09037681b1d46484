// The form that starts a fit: one button; what is chosen beside it goes along.

import { guarded, send } from "./api.js";

const form = document.querySelector("#start");
const said = form.querySelector("[role=status]");
const models = [...form.querySelectorAll("fieldset[data-model]")];

form.model.addEventListener("change", () => {
  for (const fields of models) fields.hidden = fields.disabled = fields.dataset.model !== form.model.value;
});

// Both ends of each bound that is given.
function bounds(fields) {
  const given = {};
  for (const [name, lower] of fields) {
    if (!name.startsWith("lower:")) continue;
    const parameter = name.slice("lower:".length), upper = fields.get(`upper:${parameter}`);
    if (!lower && !upper) continue;
    if (!lower || !upper) throw new Error(`${parameter}: one end of its bounds is empty. Give both, or neither.`);
    given[parameter] = [lower, upper].map(quantity);
  }
  return given;
}

function quantity(text) {
  const number = Number(text);
  return Number.isNaN(number) ? text.trim() : number;
}

// The matrix with the runs' uses as checked: this one, or a revision of it.
async function matrix() {
  const changed = [...form.querySelectorAll("[data-use]")].filter((box) => box.checked !== (box.dataset.use === "fit"));
  if (changed.length === 0) return form.elements.matrix.value;
  said.textContent = "Saving a revision with other estimation runs…";
  const runs = Object.fromEntries(changed.map((box) => [box.value, { use: box.checked ? "fit" : "verify" }]));
  return (await send("POST", form.dataset.revisions, { runs })).data.id;
}

form.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(form.querySelector("button"), form.querySelector("[role=alert]"), async () => {
    const fields = new FormData(form);
    const wanted = { model: fields.get("model") || null, method: fields.get("method"), seed: Number(fields.get("seed")) };
    wanted.effects = fields.getAll("effects");
    wanted.bounds = bounds(fields);
    if (fields.get("budget")) wanted.budget = Number(fields.get("budget"));
    if (fields.has("load")) wanted.load = fields.get("load");
    const off = [...form.querySelectorAll("[name=preprocessing]:not(:checked)")];
    if (off.length) wanted.preprocessing = Object.fromEntries(off.map((box) => [box.value, false]));
    try {
      const { data } = await send("POST", form.action, { ...wanted, matrix: await matrix() });
      location.assign(`/fits/${data.id}`);
    } finally {
      said.textContent = "";
    }
  });
});
