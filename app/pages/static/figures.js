// Figures of a fit: the same Vega-Lite definition that the service draws as SVG, PNG and PDF, made live.
// The content security policy forbids eval, so Vega runs with its expression interpreter (ast: true).

import { currentTheme } from "./theme-now.js";

let vega;

function loadVega(address) {
  vega ??= import(address).then(() => globalThis.vegaEmbed);
  return vega;
}

function query(figure) {
  const wanted = new URLSearchParams();
  for (const [name, value] of new FormData(figure.querySelector("form"))) if (value !== "") wanted.append(name, value);
  wanted.set("theme", currentTheme());
  return wanted;
}

async function draw(figure) {
  const plot = figure.querySelector(".plot");
  const wanted = query(figure);
  const note = figure.querySelector("[role=status]");
  for (const link of figure.querySelectorAll("a[data-format]")) {
    link.href = `${figure.dataset.url}.${link.dataset.format}?${wanted}`;
  }
  const turn = (figure.turn = (figure.turn ?? 0) + 1);
  plot.setAttribute("aria-busy", "true");
  note.textContent = "";
  try {
    const answer = await fetch(`${figure.dataset.url}.json?${wanted}`, { credentials: "same-origin" });
    const spec = await answer.json();
    if (!answer.ok) throw new Error([spec.what ?? spec.detail ?? spec.title, spec.remedy].filter(Boolean).join("; "));
    const embed = await loadVega(figure.dataset.vega);
    if (turn !== figure.turn) return;
    figure.view?.finalize();
    const made = await embed(plot, spec, {
      ast: true, renderer: "canvas", actions: false, defaultStyle: false, tooltip: { disableDefaultStyle: true },
    });
    figure.view = made;
    figure.dataset.drawn = wanted;
  } catch (error) {
    if (turn === figure.turn) note.textContent = `This figure cannot be drawn: ${error.message}.`;
  } finally {
    if (turn === figure.turn) plot.setAttribute("aria-busy", "false");
  }
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
  if (figure.dataset.drawn !== String(query(figure))) draw(figure);
}

for (const [place, tab] of tabs.entries()) {
  tab.addEventListener("click", () => show(tab));
  tab.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = tabs[(place + step + tabs.length) % tabs.length];
    next.focus();
    show(next);
  });
}

for (const figure of figures) {
  figure.querySelector("form").addEventListener("change", () => draw(figure));
  figure.querySelector("form").addEventListener("submit", (event) => {
    event.preventDefault();
    draw(figure);
  });
}

document.addEventListener("themechange", () => {
  for (const figure of figures) if (!figure.hidden && figure.turn) draw(figure);
});

if (tabs.length) show(tabs[0]);

// A figure without a tab is drawn when it comes near to sight.
const near = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue;
    near.unobserve(target);
    draw(target);
  }
}, { rootMargin: "400px" });
for (const figure of figures) if (figure.getAttribute("role") !== "tabpanel") near.observe(figure);
