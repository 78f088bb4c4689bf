"""The verbs that a pipeline is made of."""

from __future__ import annotations

from typing import Final

from beltrami.batch.verb import table
from beltrami.batch.verbs_of_functions import VERBS_OF_FUNCTIONS
from beltrami.batch.verbs_of_meshes import VERBS_OF_MESHES

VERBS: Final = table(**VERBS_OF_MESHES, **VERBS_OF_FUNCTIONS)
