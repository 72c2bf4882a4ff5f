#!/usr/bin/env python3
"""Fails when an include climbs: ROOMS is the order of ARCHITECTURE.md, and a room includes what stands above it only.

usage: check_includes.py SOURCE_FOLDER
"""
import pathlib
import re
import sys

ROOMS = """
base
base/drawing
ingest/meshes/formats
ingest/meshes
ingest/particles
ingest
mixtures
packing/solids
packing/tiles
packing/fill
packing/report
packing
render/embree
render/materials
render/lights
render/film
render/grains/library
render/grains
render/gsdf
render/media
render/stf
render/trace
render/equivalent
render/scene
render/build
render/integrators
render/loop
render/bench
render/stress
render/app
""".split()


def main(root):
    rank = {room: i for i, room in enumerate(ROOMS)}
    found, files = [], 0
    for top in ("base", "ingest", "mixtures", "packing", "render"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            room = path.parent.relative_to(root).as_posix()
            if room.split("/")[-1] == "benchmarks":
                continue  # programs of their own, which share builders with the tests
            if room not in rank:
                found.append(f"{room}: a folder that has no place in the order")
                continue
            files += 1
            for number, line in enumerate(path.read_text().splitlines(), 1):
                include = re.match(r'#include "(.*)/[^/]*"', line)
                if include and rank.get(include[1], len(ROOMS)) > rank[room]:
                    found.append(f"{path.relative_to(root)}:{number}: {room} must not include {include[1]}")
    print("\n".join(found) or f"{files} files, no include climbs")
    return 1 if found or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
