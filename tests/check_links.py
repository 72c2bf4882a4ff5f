#!/usr/bin/env python3
"""Fails when a room's library needs a symbol of ours from a room below it in the order of check_includes.ROOMS.

usage: check_links.py LIBRARY...     (libscree_base.a and so on, in any order)
"""
import pathlib
import re
import subprocess
import sys

sys.dont_write_bytecode = True  # the tests leave nothing in the sources
from check_includes import ROOMS  # noqa: E402


def symbols(library):
    """Names of ours that the archive defines, and those that it needs."""
    defined, needed = set(), {}
    listing = subprocess.run(["nm", "-o", library], capture_output=True, text=True, check=True).stdout
    for line in listing.splitlines():
        found = re.match(r"[^:]*:([^:]*):\s*[0-9a-f]*\s+([A-Za-z])\s+(_Z\S*5scree\S*)", line)
        if not found or not re.match(r"_Z(T[A-Z])?N?K?5scree", found[3]):
            continue  # a template of another library, with a type of ours
        member, kind, name = found.groups()
        if kind == "U":
            needed.setdefault(name, member)
        else:
            defined.add(name)
    return defined, {name: member for name, member in needed.items() if name not in defined}


def main(libraries):
    by_room = {pathlib.Path(library).stem.removeprefix("libscree_"): library for library in libraries}
    order = [room for room in ROOMS if room.replace("base/", "").replace("/", "_") in by_room]
    defined_above, climbs = {}, []
    needed_of, defined_of = {}, {}
    for room in order:
        defined_of[room], needed_of[room] = symbols(by_room[room.replace("base/", "").replace("/", "_")])
    everywhere = {name: room for room in order for name in defined_of[room]}
    for room in order:
        for name, member in sorted(needed_of[room].items()):
            if name in everywhere and name not in defined_above:
                climbs.append(f"{room} ({member}) needs {name} of {everywhere[name]}")
        defined_above.update(dict.fromkeys(defined_of[room], room))
    print("\n".join(climbs) or f"{len(order)} libraries, {len(everywhere)} symbols, none is needed from below")
    return 1 if climbs or len(order) != len(by_room) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
