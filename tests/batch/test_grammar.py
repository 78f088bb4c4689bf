import pytest

from beltrami.batch.failures import PipelineError
from beltrami.batch.grammar import written_steps

STEPS = [("repair", {}), ("spectrum", {"k": 128}), ("descriptors", {"times": [0.1, 1]})]


def test_text_list_and_file_say_the_same(tmp_path):
    text = "repair, spectrum k=128,\n descriptors times=[0.1, 1]"
    assert written_steps(text) == STEPS
    assert written_steps(STEPS) == STEPS
    assert written_steps(["repair", {"do": "spectrum", "k": 128}, STEPS[2]]) == STEPS
    file = tmp_path / "steps.toml"
    file.write_text(
        '[[step]]\ndo = "repair"\n[[step]]\ndo = "spectrum"\nk = 128\n'
        '[[step]]\ndo = "descriptors"\ntimes = [0.1, 1]\n'
    )
    assert written_steps(file) == written_steps(str(file)) == STEPS


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("1.5e-3", 0.0015),
        ("true", True),
        ("word", "word"),
        ("shape-dna", "shape-dna"),
        ('"a, b"', "a, b"),
        ("'x y'", "x y"),
        ("[1, 2]", [1, 2]),
        ("-2", -2),
    ],
)
def test_values_are_those_of_toml_or_words(text, value):
    found = written_steps(f"do x={text} y=0")[0][1]
    assert found == {"x": value, "y": 0}
    assert type(found["x"]) is type(value)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "expected a verb, found nothing"),
        ("repair,", "step 2.*found nothing"),
        ("repair spectrum", "expected name=value, found 'spectrum'"),
        ("a x=1 x=2", "'x' is given twice"),
        ("a x=", "expected name=value"),
        ("a x=[1", "expected name=value"),
        ("a x=1.2.3", "cannot read the value '1.2.3'"),
        ("a x=[1]y=2", "expected a space after"),
        ("a x=[1\n]\ny=3 = 4", "expected name=value"),
        ("a x=__import__('os')", "expected a space after"),
        ("a x=1#2", "expected a space after"),
        ("../a", "expected a verb, found '../a'"),
    ],
)
def test_what_is_not_written_so_is_told_in_one_line(text, problem):
    with pytest.raises(PipelineError, match=problem) as caught:
        written_steps(text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("thing", [3, None, [3], [("a",)], [{"k": 1}], [("a", 3)], {"do": "a"}])
def test_other_things_are_no_pipeline(thing):
    with pytest.raises(PipelineError):
        written_steps(thing)


@pytest.mark.parametrize("content", [b"step = 3", b"[x]\n", b"\xff", b"[[step", b"k=1\n[[step]]\n"])
def test_files_that_are_no_pipeline(tmp_path, content):
    file = tmp_path / "a.toml"
    file.write_bytes(content)
    with pytest.raises(PipelineError, match=r"a\.toml"):
        written_steps(file)


def test_a_missing_file_is_missing(tmp_path):
    with pytest.raises(FileNotFoundError):
        written_steps(tmp_path / "missing.toml")
