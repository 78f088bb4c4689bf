import base64
import hashlib
import re

import pytest

from beltrami.display.page_bundle import bundle, page_html, web_files
from beltrami.errors import BeltramiError

FILES = web_files()


def modules():
    return {name: text for name, text in FILES.items() if name.endswith(".js")}


@pytest.mark.parametrize("name", sorted(FILES))
def test_files_of_the_viewer_are_short_and_ask_for_nothing(name):
    text = FILES[name]
    assert len(text.splitlines()) < 300
    assert not re.search(r"https?://|@import|\bfetch\(|XMLHttpRequest|\beval\(|new Function", text)


def test_every_module_is_reached():
    script = bundle(modules())
    for name in modules():
        assert f"const ${name[:-3]} = (() => {{" in script
    assert not re.search(r"^(import|export)\b", script, re.MULTILINE)


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ({"main.js": 'import { a } from "./gone.js";\n'}, "no module gone.js"),
        ({"main.js": 'import { a } from "./one.js";\n', "one.js": "const a = 1;\n"}, "imports a"),
        (
            {
                "main.js": 'import { a } from "./one.js";\nexport const b = 1;\n',
                "one.js": 'import { b } from "./main.js";\nexport const a = 1;\n',
            },
            "circle",
        ),
        ({"main.js": 'import a from "./one.js";\n'}, "cannot be joined"),
        ({"main.js": "export default 3;\n"}, "cannot be joined"),
        ({"main.js": 'const a = "</script>";\n'}, "end the script"),
    ],
)
def test_what_cannot_be_joined_is_refused(files, message):
    with pytest.raises(BeltramiError, match=message):
        bundle(files)


def test_names_of_modules_do_not_hide_each_other():
    text = {
        "main.js": 'import { plot } from "./plot.js";\nlet found = plot();\n',
        "plot.js": "const hidden = 4;\nexport function plot() {\n  return hidden;\n}\n",
    }
    assert "const { plot } = $plot;" in bundle(text)
    assert "return { plot };" in bundle(text)


def test_the_policy_allows_this_script_and_style_alone():
    html = page_html("a < b & c", {"name": "</script><b>"}, b"data")
    policy = re.search(r'Content-Security-Policy" content="(.*?)"', html)[1]
    assert policy.startswith("default-src 'none';")
    for tag, part in ((r'<script type="module">', "script-src"), ("<style>", "style-src")):
        text = re.search(rf"{tag}(.*?)</", html, re.DOTALL)[1]
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert f"{part} 'sha256-{digest}'" in policy
    assert "unsafe" not in policy
    assert "<title>a &lt; b &amp; c</title>" in html
    assert html.count("</script>") == 3  # that of the name is written otherwise
