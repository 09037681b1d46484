// What was chosen in a form is there again on the page that shows what came of it, which `key` names; no browser lets a
// page choose a file.

const named = ({ name, type }) => name && !["hidden", "file"].includes(type);

export function remember(form, key) {
  const chosen = [...form.elements].filter(named).map(({ name, type, value, checked }) => [name, type === "checkbox" ? checked : value, value]);
  sessionStorage.setItem(key, JSON.stringify(chosen));
}

export function recall(form, key) {
  for (const [name, state, value] of JSON.parse(sessionStorage.getItem(key) ?? "[]")) {
    const field = [...form.elements].find((one) => one.name === name && (typeof state !== "boolean" || one.value === value));
    if (!field) continue;
    if (typeof state === "boolean") field.checked = state;
    else if (!field.options || [...field.options].some((option) => option.value === state)) field.value = state;
  }
}
