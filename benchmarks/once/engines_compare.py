"""Compare the engine of two trees on the gallery, on every template's example, and on random designs.

    PYTHONPATH=TREE python engines_compare.py run OUT.pickle SEED N     (once in each tree)
    python engines_compare.py compare OLD.pickle NEW.pickle
"""
from __future__ import annotations

import math, pickle, random, sys, time, warnings
from dataclasses import asdict
import numpy as np

warnings.simplefilter("ignore")


def plain(x):
    if isinstance(x, np.ndarray): return x.astype(object).tolist() if x.dtype == object else ("array", x.shape, np.asarray(x, dtype=float).ravel().tolist() if x.dtype.kind in "fiu" else x.tolist())
    if isinstance(x, np.generic): return x.item()
    if isinstance(x, dict): return {str(k): plain(v) for k, v in x.items()}
    if isinstance(x, (list, tuple)): return [plain(v) for v in x]
    if isinstance(x, (str, int, float, bool)) or x is None: return x
    return repr(x)


class Engine:
    def __init__(self):
        try:
            from app.designs.engine.calculate import calculate
            from app.designs.engine.verdicts import judged
            try: from app.designs.engine.net import Net
            except ImportError: from app.designs.engine.design import Net
            self.new = True
        except ImportError:
            from app.designs.calculate import calculate
            from app.designs.judging import judged
            from app.designs.net import Net
            self.new = False
        from app.designs.document import Document
        from app.designs.graph import Catalogues, build_graph
        from app.designs.starting import starts
        from app.reference import Reference
        from cad.catalogue import models
        from templates.door import built_in
        self.calculate, self.judged, self.Net = calculate, judged, Net
        self.Document, self.build_graph, self.starts, self.Reference = Document, build_graph, starts, Reference
        self.cat = Catalogues(built_in(), models())
        self.templates, self.models = built_in(), models()

    def design(self, raw, measures):
        doc = self.Document.model_validate(raw)
        graph, faults = self.build_graph(doc, self.cat)
        if faults: return {"graph faults": [(f.name, f.code, f.detail) for f in faults]}
        measured = (lambda s: Fake()) if measures else (lambda s: None)
        analysed = (lambda s, q, w: {n: FakeOut for n in w}) if measures else (lambda *a: None)
        try:
            calc = self.calculate(graph, measured, analysed, self.starts(doc))
        except Exception as e:  # noqa: BLE001
            return {"raised": f"{type(e).__name__}: {e}"}
        out = {"faults": [(f.name, f.code, f.detail) for f in calc.faults]}
        out["values"] = {n: plain(getattr(v, "value", v)) for n, v in calc.values.items()}
        out["typed"] = {n: plain((t.unit, t.si, str(t.tolerance))) for n, t in calc.typed.items()}
        out["steps"] = {n: {"level": plain(e.level), "error": plain(e.error), "warnings": plain(e.warnings), "inputs": plain({k: (u.value, u.unit, u.source) for k, u in e.inputs.items()}),
                            "outputs": {k: plain((a.value, a.unit, a.reason, a.reasons)) for k, a in e.outputs.items()}} for n, e in calc.evaluations.items()}
        out["pending"] = sorted(getattr(n, "name", None) or f"solid {n.model.name} {getattr(n, 'kind', '')}" for n in calc.pending)
        out["broken"] = sorted(getattr(n, "name", None) or f"solid {n.model.name} {getattr(n, 'kind', '')}" for n in calc.broken)
        out["missing"] = plain(calc.missing)
        out["shapes"] = sorted(calc.shapes)
        if not calc.faults:
            try:
                out["judged"] = {j.name: plain(asdict(j)) for j in self.judged(calc)}
            except Exception as e:  # noqa: BLE001
                out["judged"] = f"raised {type(e).__name__}: {e}"
        return out

    def rows(self, raw, varied, shares):
        refs = [self.Reference.parse(v) for v in varied]
        doc = self.Document.model_validate(raw)
        try:
            net = self.Net.of(doc, self.cat, refs, pending=True)
            given = {}
            for r in refs:
                v = np.asarray(net.nominal(r), dtype=float)
                given[r] = v * np.asarray(shares[str(r)]).reshape((-1,) + (1,) * v.ndim)
            from templates.core.language.spec import Text, Table
            wanted = [*refs, *(self.Reference(n) for n in net.graph.parameters)]
            for b in net.graph.blocks.values():
                if b.is_model: continue
                computed = net.graph.computed(b)
                wanted += [self.Reference(b.name, None, n) for n in (b.cls.formulas if computed is None else computed) if not isinstance(b.cls.formulas.get(n), Text)]
                wanted += [self.Reference(b.name, None, n) for n in list(b.cells)[:2] if b.cells[n].declared is not None and "Choice" not in type(b.cls.inputs[n]).__name__ and not isinstance(b.cls.inputs[n], Table)]
            wanted = list(dict.fromkeys(wanted))
            t = net(given, wanted, judge=True)
        except Exception as e:  # noqa: BLE001
            return {"raised": f"{type(e).__name__}: {e}"}
        return {"columns": {str(r): plain(np.asarray(c)) for r, c in t.columns.items()}, "errors": {str(r): plain(np.asarray(c)) for r, c in t.errors.items()},
                "levels": plain(t.levels), "absent": plain({str(k): v for k, v in t.absent.items()}),
                "refusals": {str(k): (r.place, r.code, r.detail) for k, r in t.refusals.items()},
                "verdicts": plain({k: v.tolist() for k, v in t.verdicts.items()}),
                "judged": {k: {n: plain(np.asarray(getattr(j, n))) for n in ("value", "limit", "low", "high", "utilisation", "margin")} | {"is_stated": j.is_stated} for k, j in t.judged.items()}}


class Fake(dict):
    def __contains__(self, k): return True
    def __getitem__(self, k): return 0.75
    def get(self, k, d=None): return 0.75


FakeOut = {"value": 0.5, "reason": None}


def read(eng, quantity, unit):
    from templates.core.units.quantity import read as r
    return r(quantity, unit)


CHEAP = None


def examples(eng):
    for id in sorted(eng.templates.ids):
        for version in (1, 2):
            try: cls = eng.templates.get(id, version)
            except Exception: continue
            if cls.example: yield f"{id} {version}", cls


def step_of(cls, inputs, **more):
    return {"template": cls.id, "version": cls.version, "inputs": inputs, **more}


def randoms(eng, seed, n, cheap):
    """Random designs: chains of examples with parameters, relations, links, levels, criteria, arrays."""
    rnd = random.Random(seed)
    names = sorted(cheap)
    for number in range(n):
        doc = {"name": f"random {number}", "parameters": {}, "steps": {}, "criteria": {}}
        known = []  # (reference, unit text, value in that unit)
        pinned = []
        for k in range(rnd.choice([1, 1, 2, 2, 3, 4])):
            key = rnd.choice(names)
            cls, results = cheap[key]
            inputs, sname = {}, f"s{k}"
            for name, raw in cls.example.items():
                declared = cls.inputs.get(name)
                inputs[name] = raw
                if declared is None or type(declared).__name__ == "Choice": continue
                try: typed = read(eng, raw, declared.meaning.unit)
                except Exception: continue
                if not isinstance(typed.si, float): 
                    if rnd.random() < 0.15 and np.ndim(typed.si) == 1 and len(known):
                        pass
                    continue
                unit, value = declared.meaning.unit, float(declared.meaning.scale.from_si(typed.si))
                wobble = value * rnd.choice([1, 1, 1, rnd.uniform(0.9, 1.1), rnd.uniform(0.5, 1.6), rnd.uniform(-0.2, 5) if rnd.random() < 0.1 else 1])
                roll = rnd.random()
                fits = [one for one in known if one[1] == unit and one[2] and value]
                if fits and roll < 0.5 and unit not in ("degC", "degF"):
                    ref, _, v0 = rnd.choice(fits)
                    f = wobble / v0
                    inputs[name] = rnd.choice([f"= {ref} * {f!r}", f"= {ref} * {f!r}", f"= max({ref} * {f!r}, 0 * {ref})", f"= {ref} * {f!r} / (1 + 0 * {ref} / {ref})"])
                elif roll < 0.65 and unit != "degC":
                    p = f"p{k}_{name}"
                    doc["parameters"][p] = {"value": wobble, "unit": unit}
                    if rnd.random() < 0.4:
                        doc["parameters"][p + "_x"] = f"= {p} * {rnd.uniform(0.97, 1.03)!r}"
                        inputs[name] = f"= {p}_x"
                        pinned.append(p)
                    else:
                        inputs[name] = f"= {p}"; pinned.append(p)
                elif roll < 0.75:
                    inputs[name] = {"value": wobble, "unit": unit}
                elif roll < 0.77:
                    inputs[name] = {"value": [wobble, wobble * 1.01, wobble * 0.9], "unit": unit}
                elif roll < 0.775:
                    inputs.pop(name)
            more = {}
            if cls.levels and rnd.random() < 0.5: 
                more["level"] = rnd.choice(list(cls.levels)[:2])
            elif cls.levels and rnd.random() < 0.15: more["tolerance"] = rnd.choice([0.2, 0.05])
            if rnd.random() < 0.3: more["outputs"] = rnd.sample(list(cls.formulas), min(3, len(cls.formulas)))
            limits = {}
            for c in cls.declared_criteria:
                for lim in c.limits:
                    if rnd.random() < 0.5:
                        v = results.get("criteria", {}).get(c.name)
                        base = v if v else 1.0
                        if rnd.random() < 0.3 and lim.unit != "degC":
                            p = f"l{k}_{lim.name}"
                            doc["parameters"][p] = {"value": base * rnd.uniform(0.6, 1.4), "unit": lim.unit}
                            limits[lim.name] = f"= {p}"
                        else:
                            limits[lim.name] = {"value": base * rnd.uniform(0.6, 1.4), "unit": lim.unit}
            if limits: more["limits"] = limits
            doc["steps"][sname] = step_of(cls, inputs, **more)
            for name, (value, unit) in results["outputs"].items():
                if isinstance(value, float) and math.isfinite(value) and value and unit and unit != "degC":
                    known.append((f"{sname}.{name}", unit, value))
                    if rnd.random() < 0.05:
                        doc["criteria"][f"c{len(doc['criteria'])}"] = {"require": f"{sname}.{name} {rnd.choice(['>=', '<='])} {value * rnd.uniform(0.7, 1.3)!r} {unit}" if unit != "1" else f"{sname}.{name} {rnd.choice(['>=', '<='])} {value * rnd.uniform(0.7, 1.3)!r}"}
                    if rnd.random() < 0.03 and unit != "1":
                        doc["parameters"][f"d{k}_{name}"] = f"= {sname}.{name} * 2"
                        doc["criteria"][f"e{len(doc['criteria'])}"] = {"require": f"d{k}_{name} >= {2 * value * rnd.uniform(0.7, 1.3)!r} {unit}"}
        if not doc["criteria"]: del doc["criteria"]
        varied = rnd.sample(sorted(set(pinned)), min(2, len(set(pinned)))) if pinned else []
        shares = {v: [rnd.uniform(0.9, 1.1) for _ in range(3)] + [rnd.choice([1.0, -1.0, 3.0])] for v in varied}
        yield f"random {number}", doc, varied, shares


def run(out, seed, n):
    eng, results = Engine(), {}
    import app
    print(app.__file__, "new" if eng.new else "old")
    from app.web.gallery import GALLERY
    cheap = {}
    for name, cls in examples(eng):
        t = time.time()
        raw = {"name": name, "steps": {"film": step_of(cls, dict(cls.example))}}
        r = results[f"example {name}"] = eng.design(raw, False)
        took = time.time() - t
        if took > 5: print(name, took)
        r["seconds"] = took
        steps = r.get("steps", {}).get("film")
        if steps and took < 0.25:
            outs = {k: (v[0], v[1]) for k, v in steps["outputs"].items()}
            crits = {j.removeprefix("film."): (c["value"]) for j, c in (r.get("judged") or {}).items() if isinstance(c, dict)}
            cheap[name] = cls, {"outputs": outs, "criteria": crits}
    for name, doc in GALLERY.items():
        raw = doc.document
        for fake in (False, True):
            t = time.time()
            results[f"gallery {name} {fake}"] = eng.design(raw, fake)
            print("gallery", name, fake, round(time.time() - t, 1), flush=True)
    # the set of cheap templates decides what is drawn: the same in both trees
    try: keep = pickle.load(open("/tmp/eng/cheap.pickle", "rb"))
    except FileNotFoundError:
        keep = sorted(cheap); pickle.dump(keep, open("/tmp/eng/cheap.pickle", "wb"))
    cheap = {}
    for name, cls in examples(eng):
        if name in keep:
            steps = results[f"example {name}"]["steps"]["film"]
            outs = {k: (v[0], v[1]) for k, v in steps["outputs"].items()}
            j = results[f"example {name}"].get("judged") or {}
            cheap[name] = cls, {"outputs": outs, "criteria": {k.removeprefix("film."): c["value"] for k, c in j.items()}}
    t = time.time()
    for name, doc, varied, shares in randoms(eng, seed, n, cheap):
        results[name] = {"doc": repr(doc), "one": eng.design(doc, False)}
        if varied and "graph faults" not in results[name]["one"]:
            results[name]["rows"] = eng.rows(doc, varied, shares)
    print(n, "random designs in", round(time.time() - t), "s")
    pickle.dump(results, open(out, "wb"))


def differences(a, b, path=""):
    if isinstance(a, float) and isinstance(b, float):
        if a != b and not (a != a and b != b) and not (math.isfinite(a) and math.isfinite(b) and abs(a - b) <= 1e-14 * max(abs(a), abs(b))): yield path, a, b
    elif isinstance(a, dict) and isinstance(b, dict):
        for k in [*a, *(k for k in b if k not in a)]:
            if k in ("seconds", "doc"): continue
            if k not in a or k not in b: yield f"{path}/{k}", a.get(k, "—"), b.get(k, "—")
            else: yield from differences(a[k], b[k], f"{path}/{k}")
    elif isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)) and len(a) == len(b):
        for i, (x, y) in enumerate(zip(a, b)): yield from differences(x, y, f"{path}/{i}")
    elif a != b: yield path, a, b


def compare(old, new):
    a, b = (pickle.load(open(f, "rb")) for f in (old, new))
    print(len(a), len(b), "cases")
    bad = verdicts = faulty = rows = refused = 0
    for name in a:
        one = a[name].get("one", a[name])
        verdicts += len(one.get("judged", ())); faulty += bool(one.get("faults"))
        r = a[name].get("rows", {})
        rows += len(r.get("columns", {})); refused += len(r.get("refusals", {}))
        if name not in b: print("missing", name); bad += 1; continue
        found = list(differences(a[name], b[name]))
        if found:
            bad += 1
            if bad <= 25:
                print("---", name, len(found))
                for p, x, y in found[:4]: print("   ", p, "| old", str(x)[:150], "| new", str(y)[:150])
    print(f"{verdicts} verdicts of one design, {faulty} faulty designs, {rows} columns of rows, {refused} refused rows; {bad} cases differ")


if __name__ == "__main__":
    if sys.argv[1] == "run": run(sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
    else: compare(*sys.argv[2:4])
