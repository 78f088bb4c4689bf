// Labelled native controls, so that keyboards and screen readers know them.

let made = 0;

export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value !== null) node.setAttribute(name, value);
  }
  node.append(...children);
  return node;
}

// A slider with its name and its value in words.
export function slider({ id, label, min, max, step = "any", value, write, change }) {
  const name = id ?? `control-${made++}`;
  const output = element("output", { for: name });
  const input = element("input", { id: name, type: "range", min, max, step });
  const tell = () => {
    const words = write(Number(input.value));
    output.textContent = words;
    input.setAttribute("aria-valuetext", words);
  };
  const set = (x) => {
    input.value = x;
    tell();
  };
  input.addEventListener("input", () => {
    tell();
    change(Number(input.value));
  });
  set(value);
  const head = element("span", { class: "row" }, element("label", { for: name }, label), output);
  return { node: element("div", { class: "control" }, head, input), input, set, tell };
}

// Times go over powers of ten: the slider is their logarithm.
export function logarithmic({ min, max, value, write, change, ...rest }) {
  const made = slider({
    ...rest,
    min: Math.log10(min),
    max: Math.log10(max),
    value: Math.log10(value),
    write: (x) => write(10 ** x),
    change: (x) => change(10 ** x),
  });
  return {
    ...made,
    set: (x) => made.set(Math.log10(x)),
    limit(low, high) {
      made.input.min = Math.log10(low);
      made.input.max = Math.log10(high);
    },
  };
}

export function checkbox({ id, label, value, change }) {
  const input = element("input", { type: "checkbox", id: id ?? `control-${made++}` });
  input.checked = value;
  input.addEventListener("change", () => change(input.checked));
  return { node: element("label", { class: "check" }, input, label), input };
}

export function select({ id, label, options, value, change }) {
  const name = id ?? `control-${made++}`;
  const input = element("select", { id: name });
  for (const [key, words] of options) input.append(element("option", { value: key }, words));
  input.value = value;
  input.addEventListener("change", () => change(input.value));
  const head = element("label", { for: name }, label);
  return { node: element("div", { class: "control pair" }, head, input), input };
}

export function button({ id, label, title, press }) {
  return element("button", { id, type: "button", title: title ?? label, onclick: press }, label);
}

// Names and numbers in two columns; set(name, text) changes one.
export function readings() {
  const list = element("dl", { class: "readings" });
  const known = new Map();
  const set = (name, text) => {
    if (!known.has(name)) {
      const cell = element("dd");
      known.set(name, cell);
      list.append(element("dt", {}, name), cell);
    }
    if (known.get(name).textContent !== text) known.get(name).textContent = text;
  };
  return { node: list, set };
}

export function words(text) {
  return element("p", { class: "words" }, text);
}
