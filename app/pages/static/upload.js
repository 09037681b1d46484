// Upload of a matrix: one zip, or matrix.yaml with its files (a folder keeps its paths). Raw files become a draft.

import { guarded, upload } from "./api.js";

const form = document.querySelector("#upload");
const drop = form.querySelector(".drop");
const button = form.querySelector("button[type=submit]");
const chosen = form.querySelector("[data-chosen]");
const problem = form.querySelector("[role=alert]");
const bar = form.querySelector("progress");
const stage = form.querySelector("[data-stage]");
const inputs = [...form.querySelectorAll("input[type=file]")];
let files = [];

function choose(list) {
  files = list;
  const bytes = files.reduce((sum, { file }) => sum + file.size, 0);
  chosen.textContent = files.length === 0 ? "" : `${files.length === 1 ? files[0].path : `${files.length} files`}, ${(bytes / 1e6).toPrecision(3)} MB`;
  button.disabled = files.length === 0;
}

// Paths relative to the folder that holds matrix.yaml.
function rooted(list) {
  const sheet = list.find(({ path }) => /(^|\/)matrix\.ya?ml$/.test(path));
  const root = sheet ? sheet.path.slice(0, sheet.path.lastIndexOf("/") + 1) : "";
  return list.filter(({ path }) => path.startsWith(root)).map(({ file, path }) => ({ file, path: path.slice(root.length) }));
}

for (const input of inputs) {
  input.addEventListener("change", () => {
    choose(rooted([...input.files].map((file) => ({ file, path: file.webkitRelativePath || file.name }))));
  });
}

async function entries(entry) {
  if (entry.isFile) {
    const file = await new Promise((done, fail) => entry.file(done, fail));
    return [{ file, path: entry.fullPath.replace(/^\//, "") }];
  }
  const reader = entry.createReader();
  const found = [];
  for (;;) {
    const batch = await new Promise((done, fail) => reader.readEntries(done, fail));
    if (batch.length === 0) return found;
    for (const child of batch) found.push(...(await entries(child)));
  }
}

for (const name of ["dragenter", "dragover"]) {
  drop.addEventListener(name, (event) => {
    event.preventDefault();
    drop.classList.add("over");
  });
}
drop.addEventListener("dragleave", () => drop.classList.remove("over"));
drop.addEventListener("drop", async (event) => {
  event.preventDefault();
  drop.classList.remove("over");
  const dropped = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
  const lists = await Promise.all(dropped.map(entries));
  choose(rooted(lists.flat()));
});

form.addEventListener("submit", (event) => {
  event.preventDefault();
  guarded(button, problem, async () => {
    const body = new FormData();
    for (const { file, path } of files) body.append("files", file, path);
    bar.closest("p").hidden = false;
    tell(0);
    try {
      const raw = !files.some(({ path }) => /(^|\/)matrix\.ya?ml$|\.zip$/i.test(path));
      const { id } = await upload(raw ? form.dataset.raw : form.action, body, tell);
      location.assign(raw ? `/drafts/${id}` : `/matrices/${id}`);
    } finally {
      bar.closest("p").hidden = true;
    }
  });
});

// All sent is not the end: the service then reads and checks every run.
function tell(share) {
  if (share < 1) bar.value = share;
  else bar.removeAttribute("value");
  stage.textContent = share < 1 ? `${Math.round(100 * share)} % sent` : "All sent. The runs are being read and checked…";
}
choose([]);
