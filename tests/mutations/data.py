"""Defects of what is read and checked: units, channels, clocks, doubts."""

from tests.mutations.mutation import Mutation

_CHECK = ("tests/checks/test_check.py",)
_SAMPLES = ("tests/readers/test_samples.py",)
_UNITS = ("tests/units/test_quantity.py",)

DATA = (
    Mutation("inch", "ident/units/names.py", "inch = 0.0254 * meter", "inch = 0.025654 * meter",
             "a factor of 1.01 in the inch", _UNITS),
    Mutation("printed-unit", "ident/units/quantity.py", "PRINTED_Z0_FACTOR = 0.0254 *", "PRINTED_Z0_FACTOR = 0.3048 *",
             "feet for inches in the printed unit of Z0", _UNITS),
    Mutation("turned-offset", "ident/readers/channel_description.py", "sign * (scale.offset + offset)",
             "scale.offset + offset", "a turned channel keeps the sign of its offset",
             ("tests/readers/test_file_types.py",)),
    Mutation("gap", "ident/readers/clock.py", "int(numbers[-1]) - (len(time) - 1)", "int(numbers[-1]) - len(time)",
             "one missing sample too few", _SAMPLES),
    Mutation("clipped", "ident/checks/clipping.py", "return count if count >= PLATEAUS else 0", "return 0",
             "plateaus are never clipping", _CHECK),
    Mutation("turned", "ident/checks/gain.py", "if turn > TURNED:", "if turn < TURNED:",
             "the sound sign is doubted, the wrong one not", _CHECK),
    Mutation("force-sign", "ident/checks/gain.py", "if agreement < -0.3 * power:", "if agreement > -0.3 * power:",
             "a force with its specimen is doubted, one against it not", _CHECK),
    Mutation("delay", "ident/checks/delay.py", "if abs(middle) >= LEAST and len(told) > 1:",
             "if abs(middle) <= LEAST and len(told) > 1:", "a bound: runs without a delay are doubted", _CHECK),
)  # fmt: skip
"""Defects of what is read and checked."""
