// Copies: a value with its unit as the program reads it, a table as text with tabs that a spreadsheet takes.

const said = document.createElement("p");
said.className = "unseen";
said.setAttribute("role", "status");
document.body.append(said);

async function copy(text, button, what) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    byHand(text);
  }
  said.textContent = `${what} is copied.`;
  button.classList.add("done");
  setTimeout(() => button.classList.remove("done"), 1500);
}

// Where the browser has no clipboard for the page, as on a plain http address.
function byHand(text) {
  const area = document.createElement("textarea");
  area.value = text;
  document.body.append(area);
  area.select();
  document.execCommand("copy");
  area.remove();
}

function button(label, text, act) {
  const made = document.createElement("button");
  made.type = "button";
  made.className = "copy";
  made.textContent = text;
  made.title = label;
  made.setAttribute("aria-label", label);
  made.addEventListener("click", () => act(made));
  return made;
}

for (const cell of document.querySelectorAll("[data-plain]")) {
  const name = cell.dataset.name ?? cell.closest("tr").querySelector("th").textContent.trim();
  const value = cell.dataset.plain;
  cell.append(button(`Copy ${name} = ${value}`, "", (made) => copy(value, made, `${name} = ${value}`)));
}

for (const table of document.querySelectorAll("table[data-copy]")) {
  const place = table.caption ?? table.createCaption();
  place.append(button("Copy the table, tab-separated", "Copy table", (made) => copy(text(table), made, "The table")));
}

function text(table) {
  return [...table.rows].map((row) => [...row.cells].map(words).join("\t")).join("\n");
}

// What a cell says, without what only its buttons say; formulas as their text.
function words(cell) {
  const bare = cell.cloneNode(true);
  for (const extra of bare.querySelectorAll(".copy, .unseen, form")) extra.remove();
  return bare.textContent.replace(/\s+/g, " ").trim();
}
