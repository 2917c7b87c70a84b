"""Monte Carlo forced response of randomly mistuned bladed disks with friction ring dampers.

A study says what is solved, ``run`` solves it, and its results are tables with percentiles:

    study = blisk.Study.from_toml("study.toml")
    results = blisk.run(study)
    print(results.summary_text)

Numbers are those of the command ``blisk``, bit for bit. Units stand in the names of keys and columns: SI, Hz, N.
"""

from ._answers import Answer, compare, optimum, plan, response
from ._errors import BliskError, Finding, InputError
from ._native import BUILD as __build__
from ._native import VERSION as __version__
from ._native import Table
from ._progress import Progress
from ._results import Best, Results
from ._run import run
from ._study import Study

__all__ = [
    "Answer",
    "Best",
    "BliskError",
    "Finding",
    "InputError",
    "Progress",
    "Results",
    "Study",
    "Table",
    "__build__",
    "__version__",
    "compare",
    "optimum",
    "plan",
    "response",
    "run",
]
