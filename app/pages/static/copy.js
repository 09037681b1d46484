// Copies: a value with its unit as the program reads it, a table as text with tabs that a spreadsheet takes, or a file.

const said = document.createElement("div");
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
  place.append(button("Download the table as a CSV file", "CSV", () => save(csv(table), "text/csv", `${fileName(table)}.csv`)));
  place.append(button("Download the table as a JSON file", "JSON", () => save(json(table), "application/json", `${fileName(table)}.json`)));
}

function text(table) {
  return cells(table).map((row) => row.join("\t")).join("\n");
}

function cells(table) {
  return [...table.rows].map((row) => [...row.cells].map(words));
}

// With the mark by which a spreadsheet knows UTF-8; text that it would take for a formula begins with an apostrophe.
function csv(table) {
  const field = (cell) => `"${cell.replace(/^(?=[=@+]|-(?!\d))/, "'").replaceAll('"', '""')}"`;
  return `\ufeff${cells(table).map((row) => row.map(field).join(",")).join("\r\n")}\r\n`;
}

// A list of objects by the heads of the columns; numbers where the page knows them, else what it shows.
function json(table) {
  const names = [...table.tHead.rows[0].cells].map((cell, place) => words(cell) || `column ${place + 1}`);
  const value = (cell) => (cell.dataset.value === undefined || cell.dataset.value === "None" ? words(cell) : Number(cell.dataset.value));
  const rows = [...table.tBodies].flatMap((body) => [...body.rows]);
  const objects = rows.map((row) => Object.fromEntries([...row.cells].map((cell, place) => [names[place], value(cell)])));
  return `${JSON.stringify(objects, null, 2)}\n`;
}

function fileName(table) {
  const title = table.closest("section")?.querySelector("h2")?.textContent ?? "table";
  return title.trim().toLowerCase().replace(/[^a-z0-9]+/g, "-");
}

function save(content, type, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([content], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// What a cell says, without what only its buttons say; formulas as their text.
function words(cell) {
  const bare = cell.cloneNode(true);
  for (const extra of bare.querySelectorAll(".copy, .unseen, form")) extra.remove();
  return bare.textContent.replace(/\s+/g, " ").trim();
}
