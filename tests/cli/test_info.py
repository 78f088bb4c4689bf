import json


def test_a_sound_mesh_is_told(beltrami, sphere):
    done = beltrami("info", sphere)
    assert done.exit_code == 0
    assert "162 vertices, 480 edges, 320 faces, 1 component" in done.stdout
    assert "no defects" in done.stdout
    assert done.stderr == ""


def test_remedies_are_commands(beltrami, stray):
    done = beltrami("info", stray)
    assert "vertices 3. `beltrami repair --remove-unreferenced`" in done.stdout
    assert "faces 1. `beltrami repair --remove-degenerate-faces`" in done.stdout


def test_json_has_the_indices(beltrami, stray):
    facts = json.loads(beltrami("info", stray, "--json").stdout)
    assert facts["unreferenced_vertices"] == [3]
    assert facts["degenerate_faces"] == [1]
    assert facts["bounding_box"] == [[0, 0, 0], [5, 5, 5]]
    assert facts["is_clean"] is False
    assert facts["has_uv"] is False


def test_a_broken_file_says_where(beltrami, tmp_path):
    path = tmp_path / "broken.off"
    path.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    done = beltrami("info", path)
    assert done.exit_code == 1
    assert done.stdout == ""
    assert f"{path}, line 6" in done.stderr
