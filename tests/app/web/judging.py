"""Sample criteria with each verdict, as the interface returns them, for tests of the page and the report."""

WORST = {
    "name": "film.film",
    "words": "the film is thicker than the permissible one",
    "require": "minimum_film_thickness >= smallest_permissible_film",
    "verdict": "not_met",
    "value": {"value": 1.53, "unit": "um"},
    "limit": {"value": 2.0, "unit": "um"},
    "band": {"value": [1.48, 1.58], "unit": "um"},
    "relative_error": 0.033,
    "error_known": True,
    "utilisation": 1.307,
    "margin": {"value": -0.47, "unit": "um"},
    "source": "DIN 31652-3",
}
UNDECIDED = {
    "name": "thick_enough",
    "words": "the film suits the filter",
    "require": "film.minimum_film_thickness >= 1.5 um",
    "verdict": "undecided",
    "value": {"value": 1.53, "unit": "um"},
    "limit": {"value": 1.5, "unit": "um"},
    "band": {"value": [1.48, 1.58], "unit": "um"},
    "relative_error": 0.033,
    "error_known": True,
    "utilisation": 0.98,
    "margin": {"value": 0.03, "unit": "um"},
    "needs": 0.019,
}
UNCHECKED = {
    "name": "film.pressure",
    "words": "the oil pressure is within what the bearing material bears",
    "require": "maximum_pressure <= permissible_pressure",
    "verdict": "not_checked",
    "value": {"value": 61.0, "unit": "MPa"},
    "error_known": False,
    "give": ["film.permissible_pressure"],
}
MET = {
    "name": "film.temperature",
    "words": "the oil stays below its limit",
    "require": "film_temperature <= 110 degC",
    "verdict": "met",
    "value": {"value": 84.0, "unit": "degC"},
    "limit": {"value": 110.0, "unit": "degC"},
    "error_known": False,
    "unverified": "no public copy of the standard was at hand",
    "waived": "accepted in test 12",
}
CRITERIA = [WORST, UNDECIDED, UNCHECKED, MET]


def verdict(*criteria):
    """The verdict over criteria, as the interface writes it."""
    words = {"not_met": "not met", "undecided": "undecided", "not_checked": "not checked", "met": "met"}
    counts = {word: sum(one["verdict"] == word for one in criteria) for word in words}
    order = ("met", "not_met", "undecided", "not_checked")
    worst = next((word for word in words if counts[word]), "met")
    governing = next((one["name"] for one in criteria if one["verdict"] != "not_checked"), None)
    stated = all(one["error_known"] and not one.get("unverified") for one in criteria)
    summary = {
        "verdict": worst,
        "counts": counts,
        "headline": ", ".join(f"{counts[word]} {words[word]}" for word in order if counts[word]),
        "green": worst == "met" and stated,
    }
    return summary | ({"governing": governing} if governing else {})
