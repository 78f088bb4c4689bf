"""The data sets: only meshes whose licence is stated for the model itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from beltrami.errors import check_name

_SOURCE = "https://raw.githubusercontent.com"
_CINOLIB = f"{_SOURCE}/mlivesu/cinolib/f67b424c271b36082e0acfdb6cac858bf82ab513"
_STEIN = f"{_SOURCE}/odedstein/meshes/835213277571d625722d25880c9c3010c6f45a5a"


@dataclass(frozen=True)
class Dataset:
    """A mesh that can be fetched, and what is known of it.

    Attributes
    ----------
    name, file, about
        What it is called here, its file, and what it is good for.
    url, sha256, size
        Where the file is, at a pinned commit; its digest, and its length in bytes.
    licence, author
        As stated for this model.
    vertices, faces, genus, boundary_loops
        Of the mesh as ``load`` returns it, polygons cut into triangles.
    """

    name: str
    file: str
    about: str
    url: str
    sha256: str
    size: int
    licence: str
    author: str
    vertices: int
    faces: int
    genus: int
    boundary_loops: int


_ALL = (
    Dataset(
        name="spot",
        file="spot_triangulated.obj",
        about="a cow: closed, with texture coordinates",
        url=f"{_CINOLIB}/examples/data/spot_triangulated.obj",
        sha256="0738b5e8608fed74e5e8c7aa8dd0af97b4b74f9f6cbf7aac84cd7e40b2e44a75",
        size=330_624,
        licence="public domain",
        author="Keenan Crane",
        vertices=2930,
        faces=5856,
        genus=0,
        boundary_loops=0,
    ),
    Dataset(
        name="spot_control",
        file="spot_control_mesh.obj",
        about="the cow's control mesh: triangles, quadrangles and pentagons",
        url=f"{_STEIN}/objects/spot/spot_control_mesh.obj",
        sha256="6798a971893be98182327670e2786e5742972a085040faed1ee11ca2d2076e67",
        size=16_626,
        licence="public domain",
        author="Keenan Crane",
        vertices=188,
        faces=372,
        genus=0,
        boundary_loops=0,
    ),
    Dataset(
        name="torus",
        file="torus.obj",
        about="an exact torus of the radii 1 and 1/4 around the y axis",
        url=f"{_STEIN}/objects/torus/torus.obj",
        sha256="f7ae0f03f26c952d208658ba70923687f67ddc7351adf15f91da7aa61dbcd119",
        size=141_907,
        licence="CC BY 4.0",
        author="Oded Stein",
        vertices=2304,
        faces=4608,
        genus=1,
        boundary_loops=0,
    ),
)
DATASETS: Final[dict[str, Dataset]] = {dataset.name: dataset for dataset in _ALL}


def names() -> tuple[str, ...]:
    """Return the names of the data sets.

    Examples
    --------
    >>> names()
    ('spot', 'spot_control', 'torus')
    """
    return tuple(DATASETS)


def describe(name: str) -> Dataset:
    """Return what is known of a data set; UnknownNameError, with all names, if there is none.

    Examples
    --------
    >>> spot = describe("spot")
    >>> spot.vertices, spot.licence, spot.author
    (2930, 'public domain', 'Keenan Crane')
    """
    return DATASETS[check_name("data set", name, names())]
