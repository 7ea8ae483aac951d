// The colours, which are those of the plugin’s window.

const [LIGHT, CONTRAST] = ["(prefers-color-scheme: light)", "(prefers-contrast: more)"].map((query) => matchMedia(query));

const look = getComputedStyle(document.documentElement);

export const colour = (name) => look.getPropertyValue(`--${name}`).trim();

// As a number, 0xRRGGBB.
export const number = (name) => Number.parseInt(colour(name).slice(1), 16);

// Sets the colours of the theme that is chosen or, as long as none is, that the system asks for. `changed()` is called after each change.
export function dress(select, controls, changed) {
  const set = () => {
    const asked = CONTRAST.matches ? "high-contrast" : LIGHT.matches ? "light" : "dark";
    const theme = select.value || asked;
    const { style } = document.documentElement;
    for (const { name, numbers: [part, value] } of controls("colour")) if (name === theme) style.setProperty(`--${part}`, value);
    style.colorScheme = theme === "light" ? "light" : "dark";
    changed();
  };
  select.onchange = set;
  for (const query of [LIGHT, CONTRAST]) query.addEventListener("change", set);
  set();
}
