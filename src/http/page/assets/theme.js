// Light, dark, or as the system has it.

const NAME = "reflectance.theme";

function kept() {
  try {
    return localStorage.getItem(NAME) ?? "";
  } catch {
    // Storage may be forbidden: the theme is the system's then.
    return "";
  }
}

function keep(chosen) {
  try {
    localStorage.setItem(NAME, chosen);
  } catch {
    // It holds until the page is left.
  }
}

function apply(chosen) {
  if (chosen) document.documentElement.dataset.theme = chosen;
  else delete document.documentElement.dataset.theme;
}

/** Applies what was chosen last, and follows the switch and the system; `changed` is called when colours did. */
export function themes(changed) {
  const select = document.getElementById("theme");
  select.value = kept();
  apply(select.value);
  select.addEventListener("change", () => {
    apply(select.value);
    keep(select.value);
    changed();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
}
