// What the reader has picked out for all figures: a run, a band, and the figure that is open. The address keeps it.

const form = document.querySelector("#pick");
const NAMES = ["run", "low", "high", "figure"];
const here = new URLSearchParams(location.search);
const state = Object.fromEntries(NAMES.map((name) => [name, here.get(name) ?? ""]));
// An address may be written by hand: a frequency that a logarithmic axis cannot have is none.
for (const name of ["low", "high"]) if (!(Number(state[name]) > 0)) state[name] = "";

export function picked() {
  return state;
}

export function pick(change) {
  for (const [name, value] of Object.entries(change)) state[name] = String(value);
  const wanted = new URLSearchParams(location.search);
  for (const name of NAMES) state[name] === "" ? wanted.delete(name) : wanted.set(name, state[name]);
  history.replaceState(null, "", `${location.pathname}${wanted.size ? `?${wanted}` : ""}${location.hash}`);
  fill();
  document.dispatchEvent(new CustomEvent("picked"));
}

function fill() {
  for (const name of NAMES) if (form?.elements[name]) form.elements[name].value = state[name];
  for (const button of document.querySelectorAll("[data-pick]")) {
    button.setAttribute("aria-pressed", button.dataset.pick === state.run);
  }
}

form?.addEventListener("change", () => {
  if (!form.reportValidity()) return;
  const { run, low, high } = Object.fromEntries(new FormData(form));
  pick({ run, low, high });
});
form?.addEventListener("submit", (event) => event.preventDefault());
form?.addEventListener("reset", (event) => {
  event.preventDefault();
  pick({ run: "", low: "", high: "" });
});
for (const button of document.querySelectorAll("[data-pick]")) {
  button.addEventListener("click", () => pick({ run: button.dataset.pick }));
}
fill();
