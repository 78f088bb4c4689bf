from html.parser import HTMLParser

from beltrami.cli.chapters.chapter import Chapter, Figure
from beltrami.cli.index_page import index_page

EVIL = "\"<script>alert('&')</script>"


class Seen(HTMLParser):
    """Collect tags, attributes and text."""

    def __init__(self):
        super().__init__()
        self.tags, self.attributes, self.text = [], {}, []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        for name, value in attrs:
            self.attributes.setdefault((tag, name), []).append(value)

    def handle_data(self, data):
        self.text.append(data)


def seen(*arguments):
    parser = Seen()
    parser.feed(index_page(*arguments))
    return parser


def test_everything_is_escaped():
    chapter = Chapter(
        EVIL,
        EVIL,
        (EVIL,),
        ((EVIL,), (EVIL,)),
        (Figure(EVIL, EVIL),),
        ((EVIL, EVIL),),
        (EVIL,),
        1.25,
        (EVIL,),
    )
    page = seen(EVIL, [EVIL], [chapter])
    assert "script" not in page.tags
    assert page.attributes["img", "src"] == [EVIL]
    assert page.attributes["img", "alt"] == [EVIL]
    assert EVIL in page.attributes["a", "href"]
    # title, h1, note, nav, h2, paragraph, two cells, caption, link, commands
    assert page.text.count(EVIL) == 11
    assert f"Section {EVIL} · 1.2 s" in page.text
    assert f"Warning: {EVIL}" in page.text


def test_the_contents_lead_to_the_chapters():
    page = seen(
        "t", [], [Chapter("The first, or not?", "", ("x",)), Chapter("Second", "3.1", ("y",))]
    )
    assert page.attributes["a", "href"] == ["#the-first-or-not", "#second"]
    assert page.attributes["h2", "id"] == ["the-first-or-not", "second"]
    assert "".join(page.text).count("Section") == 1
    assert not {"img", "table", "pre", "ul"} & set(page.tags)


def test_the_time_and_the_warnings_of_a_chapter_are_told():
    chapter = Chapter("One", "3.1", ("text",), seconds=1.25, warnings=("the noise is strong",))
    page = index_page("title", [], [chapter, Chapter("Two", "", ("text",))])
    assert '<p class="section">Section 3.1 · 1.2 s</p>' in page
    assert '<p class="warning">Warning: the noise is strong</p>' in page
    assert page.count('class="section"') == page.count('class="warning"') == 1
