// What every page needs: the theme switch, times in the reader's zone, sortable tables, scrolling by keyboard.

import { currentTheme } from "./theme-now.js";

const choice = document.querySelector("#theme");
choice.value = localStorage.getItem("theme") ?? "auto";
choice.addEventListener("change", () => {
  if (choice.value === "auto") {
    localStorage.removeItem("theme");
    delete document.documentElement.dataset.theme;
  } else {
    localStorage.setItem("theme", choice.value);
    document.documentElement.dataset.theme = choice.value;
  }
  document.dispatchEvent(new CustomEvent("themechange", { detail: currentTheme() }));
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  document.dispatchEvent(new CustomEvent("themechange", { detail: currentTheme() }));
});

for (const time of document.querySelectorAll("time[datetime]")) {
  const moment = new Date(time.dateTime);
  if (!Number.isNaN(moment.valueOf())) {
    time.textContent = moment.toLocaleString("sv-SE", { dateStyle: "short", timeStyle: "short" });
  }
}

// The title of the tab tells how a job ended that the page followed, until the reader is there.
const ended = sessionStorage.getItem("ended");
if (ended) {
  sessionStorage.removeItem("ended");
  const plain = document.title;
  document.title = `${{ succeeded: "✓ done", failed: "✗ failed", cancelled: "cancelled" }[ended] ?? ended} · ${plain}`;
  for (const act of ["pointermove", "keydown", "focus"]) addEventListener(act, () => (document.title = plain), { once: true });
}

// Whatever scrolls within the page can be reached, and then moved with the arrow keys.
const scrolling = new ResizeObserver((entries) => {
  for (const { target } of entries) {
    const hides = target.scrollWidth > target.clientWidth || target.scrollHeight > target.clientHeight;
    if (hides) target.tabIndex = 0;
    else target.removeAttribute("tabindex");
  }
});
for (const each of document.querySelectorAll(".scroll, .formula, .equation, .own .at")) scrolling.observe(each);

for (const header of document.querySelectorAll("table[data-sortable] thead th")) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "sort";
  button.append(...header.childNodes);
  header.append(button);
  button.addEventListener("click", () => sort(header));
}

function sort(header) {
  const table = header.closest("table");
  const place = [...header.parentNode.children].indexOf(header);
  const falling = header.getAttribute("aria-sort") === "ascending";
  for (const other of header.parentNode.children) other.removeAttribute("aria-sort");
  header.setAttribute("aria-sort", falling ? "descending" : "ascending");
  const key = (row) => row.children[place].dataset.value ?? row.children[place].textContent.trim();
  const rows = [...table.tBodies[0].rows];
  rows.sort((a, b) => compare(key(a), key(b)) * (falling ? -1 : 1));
  table.tBodies[0].append(...rows);
}

function compare(a, b) {
  const [x, y] = [Number(a), Number(b)];
  return a === "" || b === "" || Number.isNaN(x) || Number.isNaN(y) ? a.localeCompare(b, "en", { numeric: true }) : x - y;
}
