"""Mathcad's functions, expressed by functions of worksheets."""

from __future__ import annotations

from collections.abc import Mapping

SAME: Mapping[str, str] = {
    name: name
    for name in ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "exp", "ceil", "floor")
} | {"ln": "log"}
"""Functions of one value by name."""

WRITTEN_OUT: Mapping[str, str] = {
    "cot": "1 / tan({0})", "sec": "1 / cos({0})", "csc": "1 / sin({0})",
    "acot": "pi / 2 - atan({0})", "asec": "acos(1 / ({0}))", "acsc": "asin(1 / ({0}))",
    "coth": "1 / tanh({0})", "sech": "1 / cosh({0})", "csch": "1 / sinh({0})",
    "asinh": "log({0} + sqrt(({0})**2 + 1))", "acosh": "log({0} + sqrt(({0})**2 - 1))",
    "atanh": "log((1 + {0}) / (1 - ({0}))) / 2", "acoth": "log(({0} + 1) / ({0} - 1)) / 2",
    "asech": "log(1 / ({0}) + sqrt(1 / ({0})**2 - 1))", "acsch": "log(1 / ({0}) + sqrt(1 / ({0})**2 + 1))",
    "sinc": "sin({0}) / ({0})", "atan2": "atan2({1}, {0})",
    "angle": "if atan2({1}, {0}) < 0 then atan2({1}, {0}) + 2 * pi else atan2({1}, {0})",
    "round": "floor({0} + 0.5)", "trunc": "if {0} < 0 then ceil({0}) else floor({0})",
    "Re": "{0}",
}  # fmt: skip
"""Functions of values, item by item."""

OVER_LISTS: Mapping[str, str] = {
    "mean": "mean({0})",
    "gmean": "exp(mean(log({0})))",
    "hmean": "1 / mean(1 / ({0}))",
    "var": "mean(({0} - mean({0}))**2)",
    "Var": "sum(({0} - mean({0}))**2) / (count({0}) - 1)",
    "stdev": "sqrt(mean(({0} - mean({0}))**2))",
    "Stdev": "sqrt(sum(({0} - mean({0}))**2) / (count({0}) - 1))",
    "cvar": "mean(({0} - mean({0})) * ({1} - mean({1})))",
    "corr": "mean(({0} - mean({0})) * ({1} - mean({1})))"
    " / sqrt(mean(({0} - mean({0}))**2) * mean(({1} - mean({1}))**2))",
    "slope": "mean(({0} - mean({0})) * ({1} - mean({1}))) / mean(({0} - mean({0}))**2)",
    "intercept": "mean({1}) - mean({0}) * mean(({0} - mean({0})) * ({1} - mean({1})))"
    " / mean(({0} - mean({0}))**2)",
    "norm": "sqrt(sum(({0})**2))",
}  # fmt: skip
"""Functions that reduce one or two lists to one value."""

COUNTS = frozenset({"length", "rows", "last"})

REFUSED: Mapping[str, str] = {
    **dict.fromkeys(("augment", "stack", "submatrix", "identity", "diag", "det", "tr", "rank", "rref",
                     "geninv",
                     "eigenvals", "eigenvec", "eigenvecs", "lsolve", "matrix", "cols", "csort", "rsort",
                     "norm1",
                     "norm2", "norme", "normi", "cond1", "cond2", "conde", "condi", "svds", "genvals",
                     "genvecs",
                     "CreateMesh", "IsArray", "IsScalar"), "matrix function"),
    **dict.fromkeys(("rnd", "runif", "rnorm", "rweibull", "rt", "rexp"), "random numbers"),
    **dict.fromkeys(("READFILE", "READEXCEL", "READPRN", "READCSV", "WRITEPRN", "WRITEEXCEL"), "file"),
    **dict.fromkeys(("sort", "reverse", "match", "lookup", "vlookup", "hlookup", "vhlookup", "Rank", "mode",
                     "median", "percentile", "histogram"), "worksheets cannot sort or look up values"),
    **dict.fromkeys(("pnorm", "qnorm", "dnorm", "cnorm", "pt", "qt", "dt", "Ftest", "kurt", "skew", "Spear",
                     "kendltau", "kendltau2", "contingtbl"), "statistical function"),
    **dict.fromkeys(("lspline", "cspline", "pspline", "interp"), "spline"),
    **dict.fromkeys(("odesolve", "Odesolve", "rkfixed", "Rkadapt", "rkadapt"), "differential equation"),
    **dict.fromkeys(("fft", "FFT", "ifft", "IFFT", "cfft", "CFFT"), "Fourier transform"),
    **dict.fromkeys(("num2str", "str2num", "concat", "substr", "strlen", "search", "error"), "text"),
    **dict.fromkeys(("Find", "find", "minerr", "Minerr", "maximize", "Maximize", "minimize", "Minimize"),
                    "solve block"),
    **dict.fromkeys(("root",), "root"),
}  # fmt: skip
"""Functions that worksheets do not have, and their names in error messages."""
