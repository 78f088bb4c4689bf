// Formulas as plain text with _ and ^: "F_t = Σ_i e^{−λ_i t} φ_i".

// Pieces {text, level}: level 0 on the line, 1 raised, -1 lowered; groups may nest.
export function pieces(text, level = 0) {
  const found = [];
  let plain = "";
  const flush = () => {
    if (plain) found.push({ text: plain, level });
    plain = "";
  };
  for (let i = 0; i < text.length; i++) {
    const mark = text[i];
    if (mark !== "_" && mark !== "^") {
      plain += mark;
      continue;
    }
    flush();
    const group = groupAfter(text, i + 1);
    found.push({ group: pieces(group), level: mark === "^" ? 1 : -1 });
    i += group.length + (text[i + 1] === "{" ? 2 : 0);
  }
  flush();
  return found;
}

// What is in the braces after a mark, or the one character.
function groupAfter(text, start) {
  if (text[start] !== "{") return text[start] ?? "";
  let depth = 0;
  for (let i = start; i < text.length; i++) {
    if (text[i] === "{") depth++;
    if (text[i] === "}" && --depth === 0) return text.slice(start + 1, i);
  }
  throw new Error(`a brace is open in ${text}`);
}

export function formula(text) {
  const line = document.createElement("p");
  line.className = "formula";
  fill(line, pieces(text));
  return line;
}

function fill(parent, parts) {
  for (const part of parts) {
    if (part.group) {
      const child = document.createElement(part.level > 0 ? "sup" : "sub");
      fill(child, part.group);
      parent.append(child);
    } else parent.append(part.text);
  }
}
