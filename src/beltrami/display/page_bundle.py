"""One HTML file of the viewer's modules, its style and the data, under a strict policy."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Mapping
from html import escape
from importlib.resources import files
from string import Template
from typing import Any

from beltrami.errors import BeltramiError

_ENTRY = "main.js"
_IMPORT = re.compile(r'^import \{([^}]*)\} from "\./([a-z_]+\.js)";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export (?:async )?(?:function|class|const) ([A-Za-z_]\w*)", re.MULTILINE)
# base64.b85encode has characters that mean something in HTML, and leaves others unused.
_SAFE = bytes.maketrans(b"<>&`", b",.:/")


def web_files() -> dict[str, str]:
    """Return the text of each file of the viewer, by name."""
    folder = files("beltrami.display") / "web"
    return {
        entry.name: entry.read_text("utf-8")
        for entry in sorted(folder.iterdir(), key=lambda entry: entry.name)
        if entry.name.endswith((".js", ".css", ".html"))
    }


def bundle(modules: Mapping[str, str], entry: str = _ENTRY) -> str:
    r"""Join ES modules into one script: each becomes a function that returns what it exports.

    Modules import by ``import { a, b } from "./name.js";`` and export declarations, nothing else.

    Raises
    ------
    BeltramiError
        If a module is missing, imports in a circle, or imports what is not exported.

    Examples
    --------
    >>> print(bundle({"main.js": 'import { a } from "./one.js";\nf(a);\n',
    ...               "one.js": "export const a = 1;\n"}))
    "use strict";
    const $one = (() => {
    const a = 1;
    return { a };
    })();
    const $main = (() => {
    const { a } = $one;
    f(a);
    return {  };
    })();
    <BLANKLINE>
    """
    order: list[str] = []
    exported: dict[str, list[str]] = {}

    def visit(name: str, above: tuple[str, ...]) -> None:
        if name in above:
            raise BeltramiError(f"modules import in a circle: {' > '.join((*above, name))}")
        if name in exported:
            return
        if name not in modules:
            raise BeltramiError(f"there is no module {name}")
        for names, other in _IMPORT.findall(modules[name]):
            visit(other, (*above, name))
            missing = [n for n in _listed(names) if n not in exported[other]]
            if missing:
                raise BeltramiError(f"{name} imports {', '.join(missing)}, not in {other}")
        exported[name] = _EXPORT.findall(modules[name])
        order.append(name)

    visit(entry, ())
    wrapped = (_wrapped(name, modules[name], exported[name]) for name in order)
    return '"use strict";\n' + "".join(wrapped)


def _listed(names: str) -> list[str]:
    return [name.strip() for name in names.split(",") if name.strip()]


def _wrapped(name: str, text: str, exports: list[str]) -> str:
    def as_constant(found: re.Match[str]) -> str:
        return f"const {{ {', '.join(_listed(found[1]))} }} = ${found[2][:-3]};\n"

    body = re.sub(_EXPORT, lambda found: found[0][7:], _IMPORT.sub(as_constant, text))
    if re.search(r"^(import|export)\b", body, re.MULTILINE):
        raise BeltramiError(f"{name} imports or exports in a way that cannot be joined")
    if "</script" in body.lower():
        raise BeltramiError(f"{name} has a tag that would end the script")
    return f"const ${name[:-3]} = (() => {{\n{body}return {{ {', '.join(exports)} }};\n}})();\n"


def page_html(title: str, header: Mapping[str, Any], packed: bytes) -> str:
    """Return the page: no request leaves it, and only its own script and style run.

    Parameters
    ----------
    header
        What goes as JSON; see ``page_contents``.
    packed
        What is large, deflated; it is written in base 85.
    """
    texts = web_files()
    script = bundle({name: text for name, text in texts.items() if name.endswith(".js")})
    style = texts["style.css"]
    policy = (
        f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(style)}'; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )
    return Template(texts["page.html"]).substitute(
        title=escape(title),
        policy=policy,
        style=style,
        header=json.dumps(header, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        data=base64.b85encode(packed, pad=True).translate(_SAFE).decode(),
        length=str(len(packed)),
        script=script,
    )


def _hash(text: str) -> str:
    digest = hashlib.sha256(text.encode()).digest()
    return f"sha256-{base64.b64encode(digest).decode()}"
