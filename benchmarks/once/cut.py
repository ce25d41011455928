"""The cut before the first release: map (id, version) everywhere.  python cut.py [--without ID ...] [--probe]

Run at the root of a worktree of main, with everything committed. Idempotent: running it again maps what was added.
--without ID: leave that id as it is.  --probe: new numbers are 91, 92, so that what is not mapped no longer resolves.
"""
import json, re, subprocess, sys
from pathlib import Path

MAP = {
    "oil_film": {1: 1, 2: 2, 3: 2},
    "engine": {2: 1, 3: 1},
    "measured_curves": {1: 1, 2: 1},
    "cycle_heat_balance": {1: 1, 2: 1},
    "elastic_film": {1: 1, 2: 1},
    "oil_film_cycle": {1: 1, 2: 1, 3: 1},
    "crank_stiffness": {1: 1, 2: 1},
    "fatigue_life": {2: 1},
    "crankshaft": {1: 1, 2: 1, 3: 1},
    "plain_bearing": {1: 1, 2: 1, 3: 1},
    "thrust_washer": {2: 1},
}
NEWEST = {id: max(v) for id, v in MAP.items()}
TESTS = {  # file of tests: its new name; of an id
    "tests/templates/bearing_load/test_engine_v3.py": "test_engine_v1_articulated.py",
    "tests/templates/bearing_load/test_engine_v2.py": "test_engine_v1.py",
    "tests/templates/bearing_load/test_measured_curves_v2.py": "test_measured_curves_v1_verdicts.py",
    "tests/templates/oil_film/test_cycle_heat_balance_v2.py": "test_cycle_heat_balance_v1_supplied.py",
    "tests/templates/oil_film/test_elastic_film_v2.py": "test_elastic_film_v1_bore.py",
    "tests/templates/oil_film/test_oil_film_cycle_v2.py": "test_oil_film_cycle_v1_fed.py",
    "tests/templates/oil_film/test_oil_film_cycle_v3.py": "test_oil_film_cycle_v1_lift.py",
    "tests/templates/oil_film/test_oil_film_v3.py": "test_oil_film_v2_shapes.py",
    "tests/templates/oil_film/test_oil_film_v3_extremes.py": "test_oil_film_v2_shapes_extremes.py",
    "tests/templates/oil_film/test_oil_film_v3_heat_errors.py": "test_oil_film_v2_heat_errors.py",
    "tests/templates/stiffness/test_crank_stiffness_v2.py": "test_crank_stiffness_v1_transition.py",
    "tests/templates/stiffness/test_fatigue_life_v2.py": "test_fatigue_life_v1.py",
    "tests/cad/test_crankshaft_2.py": "test_crankshaft.py",
    "tests/cad/test_crankshaft_2_random.py": "test_crankshaft_random.py",
    "tests/cad/test_crankshaft_3.py": "test_crankshaft_split.py",
    "tests/cad/test_crankshaft_3_random.py": "test_crankshaft_split_random.py",
}
argv = sys.argv[1:]
PROBE = "--probe" in argv
if "--without" in argv:
    for id in argv[argv.index("--without") + 1 :]:
        if not id.startswith("--"): del MAP[id]
PREP = "--prep" in argv  # before the cut: every reference to an older version becomes one to the newest, by its number of today
if "--only" in argv: MAP = {id: MAP[id] for id in argv[argv.index("--only") + 1 :] if not id.startswith("--")}
if PREP: MAP = {id: {v: NEWEST[id] for v in m} for id, m in MAP.items() if id != "oil_film"}
PACKAGES = ["templates/bearing_load", "templates/oil_film", "templates/stiffness", "templates", "cad/models", "tests/golden", "tests/golden/more", "docs/drawings"]

def new(id: str, version: str | int) -> int | None:
    found = MAP[id].get(int(version))
    if found is None: return None
    return found + 90 if PROBE and (id, found) != ("oil_film", 1) else found

def git(*a): return subprocess.check_output(["git", *a], text=True)

IDS = "|".join(sorted(MAP, key=len, reverse=True))
WORDS = "|".join(sorted((id.replace("_", " ") for id in MAP), key=len, reverse=True))

def files():
    """Remove the files of older versions, rename those of the newest."""
    listed = [f for f in git("ls-files").split("\n") if f]
    staying, gone = [], []
    for f in listed:
        p = Path(f)
        if str(p.parent) not in PACKAGES and not f.startswith("templates/"): continue
        m = re.match(rf"({IDS})_v(\d)(?!\d)(.*)$", p.name)
        if not m: continue
        id, v, rest = m[1], int(m[2]), m[3]
        if (id, v) == ("oil_film", 1) : continue
        if v not in MAP[id]: continue
        # what is the newest here? the old number if its file exists yet
        newest_there = any(re.match(rf"{id}_v{NEWEST[id]}(?!\d)", Path(g).name) and str(Path(g).parent).split("/")[0] == "templates" or g == f"cad/models/{id}_v{NEWEST[id]}.py" for g in listed)
        if not newest_there and not (NEWEST[id] == MAP[id][NEWEST[id]]): continue  # cut already
        if v == NEWEST[id]: staying.append((f, str(p.parent / f"{id}_v{new(id, v)}{rest}")))
        else: gone.append(f)
    if gone: subprocess.check_call(["git", "rm", "-q", *gone])
    for old, target in staying:
        if old != target: subprocess.check_call(["git", "mv", old, target])
    for old, name in TESTS.items():
        target = str(Path(old).parent / name)
        if old in listed and any(re.match(rf"test_{id}_", Path(old).name) for id in MAP):
            subprocess.check_call(["git", "mv", old, target])

def number(m, id, v):
    n = new(m[id], m[v])
    return m[v] if n is None else str(n)

def swap(id, v):
    """Put the new number in place of group v."""
    def f(m):
        n = new(m[id].lower().replace(" ", "_"), m[v])
        if n is None: return m[0]
        a, b = m.start(v) - m.start(), m.end(v) - m.start()
        return m[0][:a] + str(n) + m[0][b:]
    return f

def listing(m):
    """`id` 1, 2 and 3: each mapped, once."""
    id, text = m["id"], m["list"]
    numbers = re.findall(r"\d", text)
    mapped = list(dict.fromkeys(n if new(id, n) is None else str(new(id, n)) for n in numbers))
    if len(numbers) == len(mapped): 
        it = iter(mapped); out = re.sub(r"\d", lambda _: next(it), text)
    elif len(mapped) == 1: out = mapped[0]
    else:
        word = re.search(r" (and|or) ", text)
        out = ", ".join(mapped) if not word or len(mapped) > 2 else f"{mapped[0]} {word[1]} {mapped[1]}"
    return m["head"] + out

E = r"""\\?["'`]"""  # a quote, perhaps escaped
RULES = [
    (re.compile(rf"(?<![A-Za-z0-9_])(?P<id>{IDS})_v(?P<v>[123])(?![0-9])"), swap("id", "v")),
    (re.compile(rf"(?<=[\"'])(?P<id>{IDS})[\"'],\s*[\"']?(?P<v>[123])(?![\w.])"), swap("id", "v")),
    (re.compile(rf"(?P<head>`(?P<id>{IDS})` )(?P<list>[123](?:(?:, | and | or |, and | \| )[123](?![\w.]))*)(?![\w.%]*[\w%])"), listing),
    (re.compile(rf"(?P<head>(?<![\w`\"'/.-])(?P<id>{IDS}) )(?P<list>[123](?:(?:, | and | or )[123](?![\w.]))*)(?![\w%]|\.\d|,\d| (?:mm|m|s|kW|cylinders)\b)"), listing),
    (re.compile(rf"(?<![\w])(?P<id>{IDS})/(?:versions/)?(?P<v>[123])(?!\d)"), swap("id", "v")),
    (re.compile(rf"(?:{E}?(?:template|id|model){E}?)[:=]\s*{E}(?P<id>{IDS}){E},\s*{E}?version{E}?\s*[:=]\s*{E}?(?P<v>[123])(?!\d)"), swap("id", "v")),
    (re.compile(rf"{E}(?P<id>{IDS}){E},?\s+{E}?(?:--)?version[ =]{E}?(?P<v>[123])(?!\d)"), swap("id", "v")),
    (re.compile(rf"(?<![\w])(?P<id>{IDS})(?:&amp;|&)version=(?P<v>[123])(?!\d)"), swap("id", "v")),
    (re.compile(rf"(?<![\w])(?P<id>{IDS})(?:,? |[\"'], [\"']|`,? )(?:--)?version[ =](?P<v>[123])(?!\d)"), swap("id", "v")),
    (re.compile(rf"(?<![\w])(?P<id>{WORDS}),? version (?P<v>[123])(?!\d)", re.I), swap("id", "v")),
]
SUFFIXES = {".py", ".md", ".toml", ".txt", ".sh", ".yml", ".cfg", ".html", ".js", ".json", ".svg", ".j2", ".csv", ".css", ".sql"}

def rewrite():
    renamed = {}
    for old, name in TESTS.items(): renamed[Path(old).name] = name
    renamed = {o: n for o, n in renamed.items() if re.match(rf"test_({IDS})_", o)}
    names = re.compile("|".join(r"(?<!\w)" + re.escape(n.removesuffix(".py")) + r"(?![\w])" for n in sorted(renamed, key=len, reverse=True)))
    for f in git("ls-files").split("\n"):
        p = Path(f)
        if not f or not p.is_file() or p.suffix not in SUFFIXES and not f.startswith(".ci"): continue
        if PREP and (re.search(rf"/({IDS})_v[0-9]+(\.py|\.release|\.accur)", f) or f.startswith("docs/drawings")): continue
        if f.startswith("tests/golden/") or f.endswith("sbom.cdx.json"): continue
        try: text = p.read_text()
        except UnicodeDecodeError: continue
        before = text
        if not PREP: text = names.sub(lambda m: renamed[m[0] + ".py"].removesuffix(".py"), text)
        for rule, repl in RULES: text = rule.sub(repl, text)
        if text != before: p.write_text(text)

def records():
    """Id, version and digest of records and releases by the project's own code."""
    sys.path.insert(0, str(Path.cwd()))
    import importlib, inspect
    from templates.core.catalogue.digests import digest, release_file
    from templates.core.catalogue.golden import golden_file, mark_released
    for f in git("ls-files", "templates", "cad/models").split("\n"):
        m = re.search(rf"/({IDS})_v(\d+)\.py$", f)
        if not m: continue
        module = importlib.import_module(f.removesuffix(".py").replace("/", "."))
        cls = next(o for o in vars(module).values() if inspect.isclass(o) and getattr(o, "id", None) == m[1] and o.__module__ == module.__name__ and getattr(o, "version", 0))
        release_file(cls).unlink(missing_ok=True)
        mark_released(cls)
        golden = golden_file(cls, Path("tests/golden"))
        text = golden.read_text()
        for key, value in (("version", cls.version), ("digest", digest(cls))):
            text, n = re.subn(rf'^( ?"{key}": ?)[^,\n]+', lambda k: k[1] + json.dumps(value), text, count=1, flags=re.M)
            assert n == 1, (golden, key)
        golden.write_text(text)
    # measured tables say of which version they are
    for f in git("ls-files", "templates").split("\n"):
        m = re.search(rf"/({IDS})_v(\d+)\.accuracy\.json$", f)
        if not m: continue
        p = Path(f); text = p.read_text()
        p.write_text(re.sub(r'("version": ?)\d+', rf"\g<1>{m[2]}", text, count=1))

def leftovers():
    """Print what names an id and a number near by, and was not mapped."""
    import ast
    allowed = {(id, n) for id, v in MAP.items() for n in (new(id, x) for x in v)}
    for f in git("ls-files").split("\n"):
        if not f.endswith(".py") or not Path(f).is_file(): continue
        text = Path(f).read_text()
        try: tree = ast.parse(text)
        except SyntaxError as e: print("SYNTAX", f, e); continue
        for n in ast.walk(tree):
            items = n.elts if isinstance(n, (ast.Tuple, ast.List, ast.Set)) else n.args if isinstance(n, ast.Call) else []
            for a, b in zip(items, items[1:]):
                if isinstance(a, ast.Constant) and a.value in MAP and isinstance(b, ast.Constant) and type(b.value) is int and (a.value, b.value) not in allowed:
                    print(f"{f}:{n.lineno}: pair {a.value} {b.value}")
            if isinstance(n, (ast.Tuple, ast.List, ast.Set)):
                seen = [ast.dump(e) for e in n.elts if isinstance(e, ast.Tuple) or (isinstance(e, ast.Constant) and isinstance(e.value, str) and e.value.partition("/")[0] in MAP)]
                for d in {d for d in seen if seen.count(d) > 1 and any(f"'{i}" in d for i in MAP)}: print(f"{f}:{n.lineno}: twice {d}")
            if isinstance(n, ast.Dict):
                pairs = {k.value: v for k, v in zip(n.keys, n.values) if isinstance(k, ast.Constant)}
                for key in ("template", "id", "model"):
                    if key in pairs and isinstance(pairs[key], ast.Constant) and pairs[key].value in MAP:
                        v = pairs.get("version")
                        if v is not None and (not isinstance(v, ast.Constant) or (pairs[key].value, v.value) not in allowed):
                            print(f"{f}:{n.lineno}: dict {pairs[key].value} {ast.unparse(v)}")
                keys = [ast.dump(k) for k in n.keys if k is not None]
                for d in {d for d in keys if keys.count(d) > 1}: print(f"{f}:{n.lineno}: key twice {d}")
            if isinstance(n, ast.Call):
                kw = {k.arg: k.value for k in n.keywords}
                for key in ("template", "id", "model"):
                    if key in kw and isinstance(kw[key], ast.Constant) and kw[key].value in MAP and "version" in kw:
                        v = kw["version"]
                        if not isinstance(v, ast.Constant) or (kw[key].value, v.value) not in allowed: print(f"{f}:{n.lineno}: call {kw[key].value} {ast.unparse(v)}")
        imports = {}
        for n in ast.walk(tree):
            if isinstance(n, ast.ImportFrom) and n.module:
                for a in n.names:
                    key = (n.module, a.name)
                    if key in imports and re.search(rf"({IDS})_v\d", n.module): print(f"{f}:{n.lineno}: imported twice {n.module} {a.name} ({imports[key]}, {a.asname})")
                    imports[key] = a.asname
                    if n.module in ("templates.oil_film", "templates.bearing_load", "templates.stiffness") and [b.name for b in n.names].count(a.name) > 1: print(f"{f}:{n.lineno}: imported twice {a.name}")

if not PREP: files()
rewrite()
if not PROBE and not PREP: records()
leftovers()
