"""Move modules and rewrite every reference.  python moves.py OLD NEW [OLD NEW ...]

OLD, NEW: paths of modules or packages (app/api/paths.py app/http/paths.py), run at the root of a worktree.
Rewrites dotted names, `from a.b import c`, and paths in py, md, toml, txt, sh, yml, cfg, html and .ci.
If the last name changes, uses of the imported module are renamed too (by the syntax tree), unless the file binds
that name otherwise: then `as old` is written and printed.
"""
import ast, re, subprocess, sys
from pathlib import Path

def dotted(p: str) -> str: return p.removesuffix(".py").rstrip("/").replace("/", ".")

def pairs(argv):
    out = []
    for old, new in zip(argv[::2], argv[1::2], strict=True):
        if old.endswith(".py"): out.append((old, new))
        else:
            for f in subprocess.check_output(["git", "ls-files", old], text=True).split("\n"):
                if f: out.append((f, new.rstrip("/") + f[len(old.rstrip("/")):]))
    return out

def main():
    argv = sys.argv[1:]
    files = pairs(argv)
    for old, new in files:
        Path(new).parent.mkdir(parents=True, exist_ok=True)
        root = Path(new).parent
        while str(root) != "." and not str(root).startswith("tests") and str(root).split("/")[0] in ("app", "cad", "templates", "benchmarks"):
            init = root / "__init__.py"
            if not init.exists() and str(init) not in [n for _, n in files] and new.endswith(".py") :
                init.write_text(f'"""{root.name.capitalize()}."""\n'); subprocess.check_call(["git", "add", str(init)])
            root = root.parent
        subprocess.check_call(["git", "mv", "-f", old, new] if not (Path(new).exists() and new.endswith("__init__.py")) else ["git", "rm", "-qf", old])
    modules = {}
    for old, new in files:
        if old.endswith("__init__.py"):
            modules[dotted(old.removesuffix("/__init__.py"))] = dotted(new.removesuffix("/__init__.py"))
        elif old.endswith(".py"): modules[dotted(old)] = dotted(new)
    paths = dict(files)
    # packages given whole, as text
    for old, new in zip(argv[::2], argv[1::2], strict=True):
        if not old.endswith(".py"): paths[old.rstrip("/") + "/"] = new.rstrip("/") + "/"
    order = sorted(modules, key=len, reverse=True)
    dot = re.compile(r"(?<![\w.])(" + "|".join(map(re.escape, order)) + r")(?![\w])(?!\.(?:html|js|css|json|csv|sql))") if order else None
    pth = re.compile(r"(?<![\w/])(" + "|".join(map(re.escape, sorted(paths, key=len, reverse=True))) + r")(?![\w])")
    frm = re.compile(r"^([ \t]*)from ([\w.]+) import (\((?:[^()]*)\)|[^\n(]+)", re.M)
    listed = subprocess.check_output(["git", "ls-files"], text=True).split("\n")
    for name in listed:
        p = Path(name)
        if not name or not p.is_file() or p.suffix not in {".py", ".md", ".toml", ".txt", ".sh", ".yml", ".cfg", ".html", ".ipynb", ".js", ".json"} and not name.startswith(".ci"): continue
        if p.suffix == ".json" and p.stat().st_size > 300_000: continue
        try: text = p.read_text()
        except UnicodeDecodeError: continue
        before = text; renames = {}
        if p.suffix == ".py" or p.suffix == ".md":
            def fix(m):
                pad, pkg, names = m.groups()
                raw = names.strip().strip("()")
                comment = "#" in raw
                items = [] if comment else [i.strip() for i in raw.replace("\n", " ").split(",") if i.strip()]
                keep, extra = [], []
                for item in items:
                    a, _, alias = item.partition(" as ")
                    full = f"{pkg}.{a.strip()}"
                    if full in modules:
                        npkg, _, nname = modules[full].rpartition(".")
                        if npkg == pkg and nname == a: keep.append(item); continue
                        if alias: extra.append((npkg, f"{nname} as {alias}" if alias != nname else nname))
                        elif nname == a: extra.append((npkg, nname))
                        else:
                            renames[a] = nname; extra.append((npkg, f"{nname} as \0{a}\0"))
                    else: keep.append(item)
                if not extra: return m.group(0)
                lines = [f"{pad}from {pkg} import " + ", ".join(keep)] if keep else []
                lines += [f"{pad}from {a} import {b}" for a, b in extra]
                return "\n".join(lines)
            text = frm.sub(fix, text)
        if renames:
            plain = text.replace("\0", "")
            tree = ast.parse(plain)
            bound = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)} | {a.arg for a in ast.walk(tree) if isinstance(a, ast.arg)} | {n.name for n in ast.walk(tree) if isinstance(n, (ast.FunctionDef, ast.ClassDef, ast.AsyncFunctionDef))}
            others = {(x.asname or x.name).split(".")[0] for n in ast.walk(tree) if isinstance(n, (ast.Import, ast.ImportFrom)) for x in n.names}
            for a, b in renames.items():
                if a in bound or b in bound or b in others:
                    print(f"{name}: kept 'as {a}' ({a} or {b} is bound otherwise)")
                    text = text.replace(f"\0{a}\0", a)
                else:
                    text = text.replace(f"{b} as \0{a}\0", b)
                    tree2 = ast.parse(text.replace("\0", ""))
                    spots = sorted({(n.lineno, n.col_offset) for n in ast.walk(tree2) if isinstance(n, ast.Name) and n.id == a}, reverse=True)
                    rows = text.split("\n")
                    for ln, col in spots:
                        line = rows[ln - 1].encode(); assert line[col:col + len(a.encode())] == a.encode(), (name, ln)
                        rows[ln - 1] = (line[:col] + b.encode() + line[col + len(a.encode()):]).decode()
                    text = "\n".join(rows)
            text = text.replace("\0", "")
        if dot: text = dot.sub(lambda m: modules[m.group(1)], text)
        text = pth.sub(lambda m: paths[m.group(1)], text)
        if text != before: p.write_text(text)
    subprocess.call("ruff check -q --select I --fix . ; ruff format -q .; ruff check -q . | head -20", shell=True)
main()
