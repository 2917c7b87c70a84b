"""Makes a mesh written by Gmsh (format inp) ready for CalculiX.

    python3 prepare.py GMSH.inp MESH.inc [NEW=SET-OTHER[-OTHER...]] [NEW=first:SET-OTHER[-OTHER...]]

Gmsh writes the faces of named surfaces as plane elements, which CalculiX would solve as well: only
solid elements are kept, the nodes they use, and the sets of both. Further arguments make node sets:
the nodes of SET that are in none of the others, or the first of them.
"""

import sys


SIZES = {"C3D4": 4, "C3D6": 6, "C3D8": 8, "C3D10": 10, "C3D15": 15, "C3D20": 20}


def blocks(path):
    """The keyword line and the numbers of each block of the file."""
    card, rows = None, []
    for line in open(path):
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            if card:
                yield card, rows
            card, rows = line.strip(), []
        elif card:
            rows.append([word.strip() for word in line.split(",") if word.strip()])
    if card:
        yield card, rows


def option(card, name):
    for word in card.split(",")[1:]:
        key, _, value = word.partition("=")
        if key.strip().upper() == name:
            return value.strip()
    return None


def lines(numbers):
    numbers = [str(number) for number in numbers]
    return "".join(",".join(numbers[i : i + 12]) + ",\n" for i in range(0, len(numbers), 12))


def main(source, target, *made):
    nodes, elements, sets = {}, {}, []
    for card, rows in blocks(source):
        keyword = card.split(",")[0].upper()
        flat = [word for row in rows for word in row]
        if keyword == "*NODE":
            nodes.update((int(row[0]), row[1:4]) for row in rows)
        elif keyword == "*ELEMENT" and option(card, "TYPE").upper() in SIZES:
            kind = option(card, "TYPE").upper()
            size = 1 + SIZES[kind]
            for i in range(0, len(flat), size):
                elements[int(flat[i])] = (kind, [int(word) for word in flat[i + 1 : i + size]])
        elif keyword in ("*ELSET", "*NSET"):
            sets.append((keyword, option(card, keyword[1:]).upper(), [int(word) for word in flat]))

    used = {node for _, members in elements.values() for node in members}
    node_sets = {name: [node for node in members if node in used] for key, name, members in sets if key == "*NSET"}
    element_sets = {name: [number for number in members if number in elements] for key, name, members in sets if key == "*ELSET"}
    for definition in made:
        name, rule = definition.split("=")
        first = rule.startswith("first:")
        chosen, *others = rule.removeprefix("first:").split("-")
        left_out = {node for other in others for node in node_sets[other]}
        members = [node for node in node_sets[chosen] if node not in left_out]
        node_sets[name] = members[:1] if first else members

    with open(target, "w") as out:
        out.write("*NODE,NSET=ALL_NODES\n")
        for node in sorted(used):
            # CalculiX reads at most 20 characters of a number.
            out.write(f"{node}," + ",".join(f"{float(x):.12e}" for x in nodes[node]) + "\n")
        for kind in sorted({kind for kind, _ in elements.values()}):
            out.write(f"*ELEMENT,TYPE={kind},ELSET=ALL_ELEMENTS\n")
            for number in sorted(elements):
                if elements[number][0] == kind:
                    out.write(lines([number, *elements[number][1]]))
        for keyword, kept in (("ELSET", element_sets), ("NSET", node_sets)):
            for name, members in kept.items():
                if members:
                    out.write(f"*{keyword},{keyword}={name}\n{lines(members)}")


main(*sys.argv[1:])
