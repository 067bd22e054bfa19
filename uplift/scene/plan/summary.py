"""Summary of a plan as text."""

from uplift.scene.plan.candidates import INDEX, Candidate, Cost, cheapest_first
from uplift.scene.plan.planning import Plan, cost_text
from uplift.viz.format import format_error, format_size, pluralise

HEADINGS = ("ΔE00", "memory", "time", "samples", "cube", "traced", "pixel")
CLEARLY_SMALLER = 0.95
"""Share of the error of a cheaper candidate that is worth a row."""
SHARE = 0.5
"""Share of the expected error of measurements below which a plan spends more than its colours are worth."""


def front_rows(plan: Plan) -> list[Candidate]:
    """The choice, and candidates whose error is clearly below that of all cheaper ones, by what the scene minimises."""
    found: list[Candidate] = []
    for each in cheapest_first(plan.measured, plan.scene.minimise):
        smallest = min((other.error.quantile for other in found), default=float("inf"))
        if each is plan.chosen or each.error.quantile < CLEARLY_SMALLER * smallest:
            found.append(each)
    return found


def front_row(measured: Candidate) -> tuple[str, ...]:
    """Texts of a candidate in the order of `HEADINGS`."""
    cost, words = measured.cost, (measured.cube_name, measured.traced, measured.pixel.name)
    costs = (format_size(cost.memory), f"{cost.time:,.0f}", f"{cost.samples:g}")
    return format_error(measured.error.quantile), *costs, *words


def verdict(plan: Plan) -> str:
    """Errors and tolerance in one phrase."""
    end = "" if plan.within_tolerance else "; the tolerance is EXCEEDED: plan for a smaller one"
    return (
        f"ΔE00 {format_error(plan.chosen.error.quantile)} predicted, {format_error(plan.confirmed.quantile)} confirmed "
        f"on other pixels, tolerance {plan.scene.tolerance:g}{end}"
    )


def notes(plan: Plan) -> list[str]:
    """What the choice costs, whether the scene needs spectra, and what its colours are worth."""
    found = [f"It costs {_costs(plan.chosen)}."]
    if plan.chosen.rendering is None:
        found.append("This scene needs no spectra: RGB and a 3 × 3 matrix per light suffice.")
    else:
        rgb = format_error(plan.without_spectra.quantile)
        found.append(f"Without spectra, by RGB and the best 3 × 3 matrix per light, ΔE00 is {rgb}.")
    if plan.chosen.pixel.form == INDEX and plan.spectra is not None:
        found.append(f"The textures have {pluralise(len(plan.spectra[0]), 'colour')}: a list of spectra suffices.")
    if plan.expected_error is not None:
        found.append(_yardstick(plan, plan.expected_error))
    return found


def _yardstick(plan: Plan, expected: float) -> str:
    """The error of the plan against that of any answer, as RGB alone does not identify a material."""
    text = f"Your colours are known within ΔE00 {expected:.2g}; this plan adds {plan.confirmed.quantile:.2g}"
    cheaper = plan.cheapest(expected)
    if plan.confirmed.quantile > SHARE * expected or cheaper is None:
        return f"{text}."
    return f"{text}. With tolerance {expected:.2g} it would need {_costs(cheaper)}."


def _costs(candidate: Candidate) -> str:
    memory, time, samples = (cost_text(candidate.cost, key) for key in Cost._fields)
    return f"{memory}, {time} and {samples}"


def describe_error(plan: Plan) -> str:
    """Definition of the errors."""
    scene = plan.scene
    materials = " and of the atlas's entries" if scene.atlases else ""
    measured = ", entries with their measurements" if scene.atlases else ""
    return (
        f"ΔE00 of {100 * scene.quantile:.4g} % of the textures' pixels{materials} is at most this value, under the "
        f"worst of {', '.join(scene.lights)}. Pixels are compared with a cube of the finest lattice and the most "
        f"coefficients at all wavelengths{measured}. {len(plan.measured):,} of {plan.considered:,} candidates were "
        "measured; the bounds of the others exclude them."
    )
