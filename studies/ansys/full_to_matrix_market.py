"""Stiffness and mass of a .full file of Ansys as files for `blisk import`.

    python full_to_matrix_market.py FILE.full [NAME]

Writes NAME_k.mtx, NAME_m.mtx and NAME_dofs.csv, and prints the lines that name them in an import file. NAME is that
of the file unless given. Needs the packages
ansys-mapdl-reader and scipy.
"""

import sys
from pathlib import Path

from ansys.mapdl import reader
from scipy.io import mmwrite
from scipy.sparse import diags, tril, triu


def lower_triangle(matrix):
    """The lower triangle of a symmetric matrix, of which one triangle is stored, or both."""
    above, below = triu(matrix, 1), tril(matrix, -1)
    if above.nnz and below.nnz and (above != below.T).nnz:
        sys.exit("the matrix is not symmetric")
    return (diags(matrix.diagonal()) + (below if below.nnz else above.T)).tocoo()


def main(path, name=None):
    name = name or Path(path).stem
    full = reader.read_binary(path)
    if full._header["ncefull"]:
        sys.exit("the model has constraint equations; write the matrices without CE and CP")
    # The upper triangles. Directions count from 0; the rows of held directions are there, and empty.
    dofs, stiffness, mass = full.load_km()
    if dofs[:, 1].max() > 2:
        sys.exit("the model has other dofs than UX, UY and UZ; only solid elements are read")
    held = set(map(tuple, full.const.tolist()))
    free = [row for row, dof in enumerate(dofs.tolist()) if tuple(dof) not in held]
    for letter, matrix in (("k", stiffness), ("m", mass)):
        kept = lower_triangle(matrix.tocsr()[free][:, free])
        mmwrite(f"{name}_{letter}.mtx", kept, field="real", precision=17, symmetry="symmetric")
    with open(f"{name}_dofs.csv", "w") as table:
        table.write("row,node,direction\n")
        for number, row in enumerate(free, start=1):
            table.write(f"{number},{dofs[row, 0]},{dofs[row, 1] + 1}\n")
    print('matrix_format = "matrix_market"\n[blisk]')
    print(f'stiffness = "{name}_k.mtx"\nmass = "{name}_m.mtx"\ndofs = "{name}_dofs.csv"')


if __name__ == "__main__":
    main(*sys.argv[1:])
