"""Real meshes by name: where they are fetched, their digests, licences and facts."""

from beltrami.datasets.load import fetch as fetch
from beltrami.datasets.load import load as load
from beltrami.datasets.registry import Dataset as Dataset
from beltrami.datasets.registry import describe as describe
from beltrami.datasets.registry import names as names

__all__ = ["Dataset", "describe", "fetch", "load", "names"]
