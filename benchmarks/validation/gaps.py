"""What was looked for without success: sources that could not be opened, templates without a case."""

NOT_OBTAINED: tuple[str, ...] = (
    "Ferron, Frêne, Boncompain 1983: temperatures and pressures of a plain bearing of 100 mm. No copy.",
    "Ma, Taylor 1996: power, flow and temperatures of two bearings of 110 mm. First page only.",
    "Vladescu et al. 2018: friction and temperature of an engine bearing machine. First page only.",
    "DuBois, Ocvirk, Wehe 1955 (NACA TN 3491): measured eccentricity, friction and flow. First page only.",
    "Fitzgerald 1986 (thesis, Sheffield): temperatures of journal bearings. Contents only.",
    "Dowson, Hudson, Hunter, March 1966 and Lund, Tonnesen 1984: temperatures of bearings. Abstracts only.",
    "Fillon et al. 1992: measured temperatures of tilting pads, which no template has.",
    "Booker 1983 (CRC Handbook II): big end of a rod. First page only.",
    "Flores et al. 2006: load diagram of a big end; its results are in a figure that was not at hand.",
    "Mendes et al. 2008: measured vibratory torque of a six-cylinder engine; curves not at hand.",
    "IACS UR M53, appendices: no copy with worked numbers.",
    "Shigley, examples 12-1 and 12-2: no copy of the examples with their numbers.",
)
"""Sources that could not be opened."""

NO_MODEL = "CAD models: no published part with all its sizes and its mass or inertia was found."
"""What no case covers beside templates."""

NOT_FOUND: dict[str, str] = {
    "crank_stiffness 1": "no published throw with its sizes and its measured or calculated stiffness",
    "crankshaft_strength 1": "no worked example of the rule",
    "cycle_heat_balance 1": "no measured temperature over an engine cycle with all inputs",
    "measured_curves 1": "it subtracts the user's own curves; there is nothing to publish",
    "thermal_clearance 1": "no worked example of a clearance in operation",
    "thermal_film 1": "measured temperatures are published (see above), but no numbers could be had",
    "thrust_bearing 1": "examples with tilting pads only, which the template does not have",
}
"""Templates without a published case, and what was looked for."""
