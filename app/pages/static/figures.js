// Figures of a fit: the same Vega-Lite definition that the service draws as SVG, PNG and PDF, made live.
// The content security policy forbids eval, so Vega runs with its expression interpreter (ast: true).

import { pick, picked } from "./pick.js";
import { currentTheme } from "./theme-now.js";

let vega;

function loadVega(address) {
  vega ??= import(address).then(() => globalThis.vegaEmbed);
  return vega;
}

const CONDITIONS = ["kp", "amplitude", "specimen", "use"];

function query(figure) {
  const wanted = new URLSearchParams(figure.dataset.fixed);
  const form = figure.querySelector("form");
  const chosen = Object.entries(picked()).filter(([name]) => (figure.dataset.picked ?? "").split(" ").includes(name));
  // One run leaves nothing to choose by its conditions, but on the map, where it is only marked.
  const one = figure.id !== "figure-residual-map" && chosen.some(([name, value]) => name === "run" && value);
  for (const name of CONDITIONS) if (form?.elements[name]) form.elements[name].disabled = one;
  for (const [name, value] of [...(form ? new FormData(form) : []), ...chosen]) if (value !== "") wanted.append(name, value);
  wanted.set("theme", currentTheme());
  return wanted;
}

// True where the figure that is there could follow by its own signals, at once, without the service.
async function moved(figure, wanted) {
  if (!figure.view || figure.dataset.drawn === undefined) return false;
  const before = new URLSearchParams(figure.dataset.drawn);
  const changed = [...new Set([...before.keys(), ...wanted.keys()])].filter((name) => before.get(name) !== wanted.get(name));
  if (!changed.every((name) => figure.signals.has(name))) return false;
  for (const name of changed) figure.view.signal(name, name === "run" ? wanted.get(name) ?? "" : Number(wanted.get(name)));
  await figure.view.runAsync(); // what others ask of the service is under way meanwhile
  return true;
}

// What of a definition stays as it is while its data and the values of its parameters are exchanged.
function frame({ datasets, params = [], ...fixed }) {
  return JSON.stringify([fixed, Object.keys(datasets ?? {}), params.map(({ value, ...param }) => param)]);
}

// True where the figure that is there could take over what a new definition shows.
async function refilled(figure, { datasets, params }, kept) {
  if (!figure.view || figure.frame !== kept) return false;
  for (const { name, value } of params ?? []) if (value !== undefined) figure.view.signal(name, value);
  for (const [name, rows] of Object.entries(datasets)) figure.view.data(name, rows);
  await figure.view.resize().runAsync(); // words of another length need another place
  return true;
}

// The canvas says in words what is drawn: the heading of the figure, which follows what the figure shows.
function name(figure) {
  const { text, subtitle } = figure.heading ?? {};
  const said = (part) => [part?.expr ? figure.view.signal(part.expr) : part].flat().filter(Boolean);
  const canvas = figure.querySelector("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", [...said(text), ...said(subtitle)].join(". ") || figure.querySelector(".plot").ariaLabel);
}

// Whether a figure waits for a job that nobody has started: that is no error.
function isUnmade(figure, { code }) {
  return code === "too-long" && figure.closest("[data-unmade]") !== null;
}

async function draw(figure) {
  const plot = figure.querySelector(".plot");
  const wanted = query(figure);
  const note = figure.querySelector("[role=status]");
  const hand = wanted.toString();
  for (const link of figure.querySelectorAll("a[data-format]")) {
    link.href = `${figure.dataset.url}.${link.dataset.format}?${wanted}`;
  }
  const turn = (figure.turn = (figure.turn ?? 0) + 1);
  plot.setAttribute("aria-busy", "true");
  note.textContent = "";
  try {
    if (await moved(figure, wanted)) {
      if (turn !== figure.turn) return;
      figure.dataset.drawn = hand;
      return name(figure);
    }
    const address = `${figure.dataset.url}.json?${wanted}&share=${figure.dataset.share}&live=1`;
    figure.asked?.abort(); // nobody waits for the answer before
    figure.asked = new AbortController();
    const answer = await fetch(address, { credentials: "same-origin", signal: figure.asked.signal });
    const spec = await answer.json();
    note.classList.toggle("error", !isUnmade(figure, spec));
    if (isUnmade(figure, spec)) return void (note.textContent = figure.closest("[data-unmade]").dataset.unmade);
    if (!answer.ok) throw new Error([spec.what ?? spec.detail ?? spec.title, spec.remedy].filter(Boolean).join("; "));
    figure.dispatchEvent(new CustomEvent("arrived", { detail: spec }));
    if (turn !== figure.turn) return;
    const kept = frame(spec);
    if (!(await refilled(figure, spec, kept))) await embedded(figure, plot, spec, turn);
    if (turn !== figure.turn) return;
    figure.frame = kept;
    figure.dataset.drawn = hand;
    figure.heading = typeof spec.title === "string" ? { text: spec.title } : spec.title;
    name(figure);
  } catch (error) {
    note.classList.add("error");
    if (turn === figure.turn) note.textContent = `This figure cannot be drawn: ${error.message}.`;
  } finally {
    if (turn === figure.turn) plot.setAttribute("aria-busy", "false");
  }
}

async function embedded(figure, plot, spec, turn) {
  const embed = await loadVega(figure.dataset.vega);
  if (turn !== figure.turn) return;
  figure.view?.finalize();
  figure.view = undefined;
  const { view } = await embed(plot, spec, {
    ast: true, renderer: "canvas", actions: false, defaultStyle: false, tooltip: { disableDefaultStyle: true },
  });
  if (turn !== figure.turn) return view.finalize();
  figure.view = view;
  figure.signals = new Set((spec.params ?? []).map(({ name }) => name));
  listen(figure);
}

// A square that is clicked, a band that is drawn: both are picked out for every figure.
function listen(figure) {
  if (!figure.dataset.picked) return;
  const { view } = figure;
  let band, brushed = false;
  view.addEventListener("mousedown", () => (brushed = false));
  view.addEventListener("click", (event, item) => {
    const { r: run, f: low, g: high } = item?.datum ?? {};
    if (!run || brushed || figure.id !== "figure-residual-map") return;
    pick(low === undefined ? { run } : { run, low: short(low), high: short(high) });
  });
  if (!figure.signals.has("brush")) return;
  view.addSignalListener("brush", (_, value) => (band = Object.values(value).find(Array.isArray)));
  figure.querySelector(".plot").onpointerup = () => setTimeout(() => {
    if (!band) return;
    const [low, high] = band.map(short);
    [band, brushed] = [undefined, true];
    view.data("brush_store", []).run();
    if (low < high) pick({ low, high });
  });
}

function short(frequency) {
  return Number(frequency.toPrecision(3));
}

const figures = [...document.querySelectorAll(".figure")];
const tabs = [...document.querySelectorAll("[role=tab]")];

function show(tab) {
  for (const other of tabs) {
    const on = other === tab;
    other.setAttribute("aria-selected", on);
    other.tabIndex = on ? 0 : -1;
    document.getElementById(other.getAttribute("aria-controls")).hidden = !on;
  }
  const figure = document.getElementById(tab.getAttribute("aria-controls"));
  refresh(figure);
}

// A figure in a section that is not shown has no width to be drawn in.
function refresh(figure) {
  if (figure.offsetParent !== null && figure.dataset.drawn !== String(query(figure))) draw(figure);
}

function choose(tab) {
  show(tab);
  pick({ figure: tab.id.replace("tab-", "") });
}

for (const [place, tab] of tabs.entries()) {
  tab.addEventListener("click", () => choose(tab));
  tab.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = tabs[(place + step + tabs.length) % tabs.length];
    next.focus();
    choose(next);
  });
}

for (const form of figures.map((figure) => figure.querySelector("form")).filter(Boolean)) {
  form.addEventListener("change", () => draw(form.closest(".figure")));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    draw(form.closest(".figure"));
  });
}

for (const name of ["themechange", "picked", "sectionshown"]) {
  document.addEventListener(name, () => {
    for (const figure of figures) {
      if (figure.turn || figure.getAttribute("role") === "tabpanel") refresh(figure);
    }
  });
}

if (tabs.length) show(tabs.find((tab) => tab.id === `tab-${picked().figure}`) ?? tabs[0]);

// A figure without a tab is drawn when it comes near to sight.
const near = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue;
    near.unobserve(target);
    draw(target);
  }
}, { rootMargin: "400px" });
for (const figure of figures) if (figure.getAttribute("role") !== "tabpanel") near.observe(figure);
