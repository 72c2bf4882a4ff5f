"""The shipped schema accepts what the program accepts: the examples, good scenes and broken scenes.

    schema_test.py SCHEMA SCREE PLAN_SCENES EXAMPLES

For every scene, validation against the schema must agree with the exit code of `scree render SCENE --plan` (0 or 2).
Starting scree takes a third of a second, so PLAN_SCENES checks many scenes in one process; scree itself checks the
examples and some others. A broken scene is the good scene with one change. Conditions that a schema cannot express (a
target that differs from the origin) are listed separately: only the program must refuse those scenes.
"""

import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema

GOOD = {
    "camera": {"kind": "perspective", "origin": [0, -10, 2], "target": [0, 0, 1], "up": [0, 0, 1], "fov": 35, "aperture": 0, "focus": 0},
    "film": {"size": [16, 12], "filter": "gaussian", "aov": ["albedo", "normal", "depth", "type", "id", "variance", "samples"]},
    "lights": [
        {"kind": "constant", "radiance": 1},
        {"kind": "distant", "direction": [0.3, 0.2, -1], "irradiance": [3, 3, 2.8], "angle": 0.53},
        {"kind": "rectangle", "corner": [0, 0, 9], "edges": [[1, 0, 0], [0, 1, 0]], "radiance": 10},
        {"kind": "sphere", "center": [0, 0, 9], "radius": 1, "radiance": [1, 2, 3]},
    ],
    "surfaces": [{"mesh": "tetra.obj", "material": {"kind": "conductor", "eta": 0.2, "k": [3, 3, 3], "roughness": 0.2, "tint": 1}}],
    "grains": {
        "types": {
            "glass": {"shape": "sphere", "material": {"kind": "dielectric", "ior": 1.5, "roughness": 0, "absorption": [0, 1, 2], "tint": 0.98}},
            "pebble": {"shape": {"mesh": "tetra.obj"}, "material": {"kind": "lambert", "reflectance": 0.6}},
        },
        "assembly": {"dump": "two.dump", "types": {"1": "glass", "2": "pebble"}, "radius": {"1": 0.5, "2": 0.25}},
        "mixture": {"kind": "explicit"},
    },
    "medium": [{"mesh": "tetra.obj", "sigma_t": [1, 2, 3], "albedo": 0.9, "g": 0.5}],
    "integrator": {"kind": "auto", "accuracy": "standard", "max_depth": 9},
}

REMOVE = object()

# (path of keys, value): each change alone makes another good scene.
GOOD_CHANGES = [
    ((), {}),
    (("$schema",), "scene.schema.json"),
    (("film",), REMOVE), (("lights",), REMOVE), (("lights",), []), (("surfaces",), REMOVE), (("grains",), REMOVE), (("medium",), REMOVE), (("medium",), []), (("medium", 0, "albedo"), [0, 0, 1]), (("medium", 0, "g"), -0.99), (("integrator", "kind"), "vpt"), (("integrator", "medium_form"), "plain"),
    (("integrator",), REMOVE), (("integrator",), {}), (("integrator", "kind"), "ept"), (("integrator", "kind"), "ppt"), (("integrator", "explicit_grains"), 1), (("integrator", "max_depth"), 1),
    (("integrator", "kind"), "stf"), (("integrator", "shells"), True), (("integrator", "shells"), False), *[(("integrator", "stf_form"), form) for form in ("full", "cosine", "hg", "interpolated", "diffusion")],
    (("camera",), {"origin": [0, 1, 0], "target": [0, 0, 0]}),
    (("camera",), {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0], "width": 4, "aperture": 1, "focus": 2}),
    (("camera", "fov"), 179.5), (("camera", "fov"), 1e-3),
    (("film", "size"), [65536, 1]), (("film", "size"), [16.0, 12]), (("film", "aov"), []), (("film", "aov"), ["id", "id"]),
    (("film", "filter"), "box"), (("film", "filter"), {"kind": "tent"}), (("film", "filter"), {"kind": "gaussian", "radius": 2}),
    (("lights", 0), {"kind": "constant"}), (("lights", 0, "radiance"), [0, 0, 0]), (("lights", 1, "angle"), 0), (("lights", 1, "angle"), 180),
    (("surfaces", 0, "material"), {"kind": "lambert"}), (("surfaces", 0, "material"), {"kind": "dielectric"}),
    (("surfaces", 0, "material"), {"kind": "conductor", "eta": 0, "k": 0}),
    (("grains", "types", "glass", "material", "ior"), 0.1), (("grains", "types", "glass", "material", "ior"), 10),
    (("grains", "mixture"), REMOVE), (("grains", "mixture"), "glass"), (("grains", "mixture"), {"kind": "random", "types": ["glass", "pebble"], "weights": [1, 3]}),
    (("grains", "mixture"), {"kind": "explicit", "types": {"1": "pebble", "2": "glass"}}),
    (("grains", "mixture"), {"kind": "perlin", "types": ["glass", "pebble"], "scale": 2}),
    (("grains",), {**GOOD["grains"], "mixture": {"kind": "random", "types": ["glass"]}, "assembly": {"dump": "two.dump", "radius": 1}}),
    (("grains", "assembly", "radius"), 0.5),
    (("grains", "assembly"), {"spheres": []}),
    (("grains", "assembly"), {"spheres": [{"center": [0, 0, 0], "radius": 0, "type": "glass"}]}),
    (("grains",), {"types": {"only": {"shape": "sphere", "material": {"kind": "lambert"}}}, "assembly": {"dump": "two.dump", "radius": 1}}),
    (("grains",), {"types": {"only": {"shape": "sphere", "material": {"kind": "lambert"}}}, "assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1}]}}),
    *[(("grains", "types", "glass"), {"shape": name}) for name in (
        "sugar", "brown_sugar", "ice", "snowflake", "white_sand", "yellow_sand", "brown_sand", "dark_brown_sand", "black_sand", "flour", "hairball",
        "cinnamon", "dielectric_sphere", "diffuse_sphere")],
    (("grains", "types", "glass", "shape"), "sugar"), (("grains", "types", "glass", "shape"), {"library": "sugar"}),
    (("grains", "types", "glass"), {"shape": {"library": "sugar", "triangles": 20, "seed": 3, "parameters": {"chips": 9, "rounding": 0.05}}}),
    (("grains", "types", "glass"), {"shape": {"library": "diffuse_sphere", "triangles": 80, "parameters": {}}}),
    (("grains", "unit"), "m"), (("grains", "unit"), "cm"), (("grains", "unit"), "mm"), (("grains", "unit"), "um"), (("grains", "unit"), 0.0254),
]

# Each change alone makes a scene that the schema and the program refuse.
BAD_CHANGES = [
    (("camera",), REMOVE), (("camra",), {}), (("camera",), []), (("camera", "kind"), "fisheye"), (("camera", "origin"), REMOVE), (("camera", "target"), [0, 0]),
    (("camera", "target"), [0, 0, "1"]), (("camera", "up"), [0, 0, 0]), (("camera", "fov"), 0), (("camera", "fov"), 180), (("camera", "fov"), "wide"),
    (("camera", "width"), 3), (("camera", "aperture"), -1), (("camera", "focus"), -1), (("camera", "fovy"), 3),
    (("camera",), {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0]}),
    (("camera",), {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0], "width": 0}),
    (("camera",), {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0], "width": 1, "fov": 40}),
    (("film",), []), (("film", "size"), [1]), (("film", "size"), [1, 2, 3]), (("film", "size"), [0, 1]), (("film", "size"), [1, 65537]),
    (("film", "size"), [1.5, 1]), (("film", "filter"), "sinc"), (("film", "filter"), {"radius": 1}), (("film", "filter"), {"kind": "box", "radius": 0}),
    (("film", "filter"), {"kind": "box", "width": 1}), (("film", "aov"), "depth"), (("film", "aov"), ["Z"]), (("film", "spp"), 16),
    (("lights",), {}), (("lights", 0), {}), (("lights", 0, "kind"), "sun"), (("lights", 0, "radiance"), -1), (("lights", 0, "radiance"), [1, 2]),
    (("lights", 0, "radiance"), 1e39), (("lights", 0, "radiance"), "1"), (("lights", 0, "scale"), 1), (("lights", 0), {"kind": "environment"}),
    (("lights", 0), {"kind": "environment", "file": ""}), (("lights", 0), {"kind": "environment", "file": "no.exr", "up": [0, 0, 0]}),
    (("lights", 1, "direction"), REMOVE), (("lights", 1, "direction"), [0, 0, 0]), (("lights", 1, "angle"), 181), (("lights", 1, "radiance"), 1),
    (("lights", 2, "edges"), [[1, 0, 0]]), (("lights", 2, "edges"), REMOVE), (("lights", 2, "corner"), 3), (("lights", 3, "radius"), 0),
    (("lights", 3, "center"), REMOVE), (("lights", 3, "corner"), [0, 0, 0]),
    (("surfaces", 0, "mesh"), REMOVE), (("surfaces", 0, "mesh"), ""), (("surfaces", 0, "mesh"), 3), (("surfaces", 0, "material"), REMOVE),
    (("surfaces", 0, "material"), "lambert"), (("surfaces", 0, "material", "kind"), "metal"), (("surfaces", 0, "material", "eta"), REMOVE),
    (("surfaces", 0, "material", "k"), -1), (("surfaces", 0, "material", "roughness"), 1.1), (("surfaces", 0, "material", "tint"), [1, 1, 2]),
    (("surfaces", 0, "material", "ior"), 1.5), (("surfaces", 0, "scale"), 2),
    (("grains", "types"), REMOVE), (("grains", "types"), {}), (("grains", "types", "glass", "shape"), "cube"), (("grains", "types", "glass", "shape"), {"mesh": ""}),
    (("grains", "types", "glass", "shape"), {"mesh": "tetra.obj", "scale": 1}), (("grains", "types", "glass", "material"), REMOVE),
    (("grains", "types", "glass", "material", "ior"), 0.05), (("grains", "types", "glass", "material", "absorption"), -1),
    (("grains", "types", "pebble", "material", "reflectance"), 1.5), (("grains", "types", "pebble", "material", "tint"), 1), (("grains", "types", "pebble", "color"), 1),
    (("grains", "types", "glass"), {"shape": "sphere"}), (("grains", "types", "glass"), {"shape": {"mesh": "tetra.obj"}}), (("grains", "types", "glass"), {}),
    (("grains", "types", "glass"), {"shape": "suger"}), (("grains", "types", "glass", "shape"), {"library": "sphere"}), (("grains", "types", "glass", "shape"), 3),
    (("grains", "types", "glass", "shape"), {"library": "sugar", "mesh": "tetra.obj"}), (("grains", "types", "glass", "shape"), {"library": "sugar", "triangles": 19}),
    (("grains", "types", "glass", "shape"), {"library": "sugar", "triangles": 4000001}), (("grains", "types", "glass", "shape"), {"library": "sugar", "triangles": 30.5}),
    (("grains", "types", "glass", "shape"), {"library": "sugar", "seed": -1}), (("grains", "types", "glass", "shape"), {"library": "sugar", "parameters": []}),
    (("grains", "types", "glass", "shape"), {"library": "sugar", "parameters": {"chips": "many"}}), (("grains", "types", "glass"), {"shape": "sugar", "material": "ice"}),
    (("grains", "unit"), 0), (("grains", "unit"), -1), (("grains", "unit"), "inch"), (("grains", "unit"), [1]), (("grains", "unit"), 1e31),
    (("grains", "assembly"), REMOVE), (("grains", "assembly"), {}), (("grains", "assembly"), {"fill": "a.off"}), (("grains", "assembly", "spheres"), []),
    (("grains", "assembly", "types"), REMOVE), (("grains", "assembly", "types"), {}), (("grains", "assembly", "types"), {"one": "glass"}),
    (("grains", "assembly", "types"), {"01": "glass"}), (("grains", "assembly", "types"), {"+1": "glass"}), (("grains", "assembly", "types"), {"1": 3}),
    (("grains", "assembly", "radius"), 0), (("grains", "assembly", "radius"), "1"), (("grains", "assembly", "radius"), {"1": 0}),
    (("grains", "assembly", "radius"), {"big": 1}), (("grains", "assembly", "dump"), ""),
    (("grains", "assembly"), {"spheres": [{"center": [0, 0, 0], "radius": 1}]}),
    (("grains", "assembly"), {"spheres": [{"center": [0, 0, 0], "radius": -1, "type": "glass"}]}),
    (("grains", "assembly"), {"spheres": [{"radius": 1, "type": "glass"}]}), (("grains", "assembly"), {"spheres": {}}),
    (("grains", "mixture"), {}), (("grains", "mixture", "kind"), "perlin"), (("grains", "mixture", "kind"), "marble"),
    (("grains", "mixture"), {"kind": "random", "types": []}), (("grains", "mixture"), 3), (("grains", "mixture", "seed"), 1), (("grains", "mixture"), {"file": ""}),
    (("grains", "seed"), 1),
    (("medium", 0, "sigma_t"), REMOVE), (("medium", 0, "mesh"), REMOVE), (("medium", 0, "g"), 1), (("medium", 0, "albedo"), 1.1), (("medium", 0, "sigma_t"), -1),
    (("medium", 0, "density"), "density"), (("integrator", "grain_depth"), -1), (("integrator", "grain_pixels"), -1), (("integrator", "grain_flights"), -1), (("integrator", "least_shell"), -1), (("integrator", "medium_form"), "best"),
    (("integrator", "kind"), "sft"), (("integrator", "shells"), "on"), (("integrator", "shells"), 1), (("integrator", "stf_form"), "best"), (("integrator", "stf_form"), True), (("integrator", "shels"), True),
    (("medium",), [{"mesh": "slab.off"}]), (("medium",), {}), (("integrator",), "ept"), (("integrator", "kind"), "epd"), (("integrator", "explicit_grains"), -1), (("integrator", "accuracy"), "best"),
    (("integrator", "max_depth"), 0), (("integrator", "max_depth"), 1.5), (("integrator", "depth"), 3), (("$schema",), 3), (("lihgts",), []),
]

# Errors that only the program can detect.
BEYOND_A_SCHEMA = [
    (("camera", "target"), [0, -10, 2]), (("camera", "up"), [0, -10, 1]), (("lights", 2, "edges"), [[1, 0, 0], [2, 0, 0]]),
    (("grains", "assembly", "types"), {"1": "glass", "2": "pebbel"}), (("grains", "assembly", "types"), {"1": "glass"}),
    (("grains", "assembly", "dump"), "no.dump"), (("surfaces", 0, "mesh"), "no.obj"), (("grains", "mixture"), "granite"),
    (("grains", "mixture"), {"kind": "random", "types": ["glass", "granite"]}), (("grains", "mixture"), {"file": "no.json"}),
    (("grains", "assembly", "types"), {"99999999999": "glass"}),
    (("grains", "types", "glass", "shape"), {"library": "sugar", "parameters": {"chps": 3}}),
    (("grains", "types", "glass", "shape"), {"library": "sugar", "parameters": {"chips": 31}}),
]


def changed(path, value):
    scene = copy.deepcopy(GOOD)
    if not path:
        return scene
    parent = scene
    for key in path[:-1]:
        parent = parent[key]
    if value is REMOVE:
        del parent[path[-1]]
    else:
        parent[path[-1]] = value
    return scene


def without_comments(text):
    """JSON with // and /* */ comments as plain JSON; texts in quotes are left alone."""
    return re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda m: m.group(1) or " ", text, flags=re.S)


def main():
    schema_file, scree, plan_scenes, examples = sys.argv[1:]
    schema = json.loads(pathlib.Path(schema_file).read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    # Resolves the reference to the mixtures' schema, which is a relative path.
    resolver = jsonschema.RefResolver(pathlib.Path(schema_file).resolve().as_uri(), schema)
    validator = jsonschema.Draft202012Validator(schema, resolver=resolver)
    failures = []

    def program_accepts(file):
        run = subprocess.run([scree, "render", str(file), "--plan", "-o", "/tmp/never.exr"], capture_output=True, text=True)
        if run.returncode not in (0, 2):
            failures.append(f"{file}: exit code {run.returncode}: {run.stderr}")
        return run.returncode == 0, run.stderr.strip()

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "tetra.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        (folder / "two.dump").write_text("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n-2 2\n-2 2\n-2 2\n"
                                         "ITEM: ATOMS id type x y z\n1 1 0 0 0\n2 2 1 0 0\n")
        cases = [(path, value, True, True) for path, value in GOOD_CHANGES]
        cases += [(path, value, False, False) for path, value in BAD_CHANGES]
        cases += [(path, value, True, False) for path, value in BEYOND_A_SCHEMA]

        files = []
        for number, (path, value, _, _) in enumerate(cases):
            files.append(folder / f"scene{number}.json")
            files[-1].write_text(json.dumps(changed(path, value)))
        run = subprocess.run([plan_scenes, *map(str, files)], capture_output=True, text=True, check=True)
        verdicts = [line.removeprefix("verdict ") for line in run.stdout.splitlines() if line.startswith("verdict ")]
        if len(verdicts) != len(cases):
            failures.append(f"{len(verdicts)} verdicts on {len(cases)} scenes: {run.stderr}")

        for number, ((path, value, schema_accepts, accepted), file, verdict) in enumerate(zip(cases, files, verdicts)):
            what = "/".join(map(str, path)) + (" removed" if value is REMOVE else f" = {value!r}")
            errors = [f"{'/'.join(map(str, e.absolute_path))}: {e.message}" for e in validator.iter_errors(changed(path, value))]
            if (not errors) != schema_accepts:
                failures.append(f"{what}: the schema says {errors or 'nothing wrong'}")
            if (verdict == "0") != accepted:
                failures.append(f"{what}: the program says {verdict}")
            if number % 25 == 0 and program_accepts(file)[0] != accepted:
                failures.append(f"{what}: the program's exit code is not the verdict {verdict}")

    scenes = sorted(pathlib.Path(examples).glob("*/scene.json"))
    if not scenes:
        failures.append(f"no scene in {examples}")
    for file in scenes:
        for error in validator.iter_errors(json.loads(without_comments(file.read_text()))):
            failures.append(f"{file}: /{'/'.join(map(str, error.absolute_path))}: {error.message}")
        good, message = program_accepts(file)
        if not good:
            failures.append(f"{file}: {message}")

    print(f"{len(cases)} scenes and {len(scenes)} examples, {len(failures)} disagreements")
    print("\n".join(failures))
    return 1 if failures else 0


sys.exit(main())
