"""The units that a test bench writes, as definitions for pint.

pint's own list is not used: it reads ``Nm`` as number-metres, ``G`` as gauss, ``mil`` as an angle and ``ton`` as the
US short ton. What is not here is unknown, and an unknown unit is an error, never a guess.
"""

PREFIXES = """
pico- = 1e-12 = p-
nano- = 1e-9 = n-
micro- = 1e-6 = µ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
deci- = 1e-1 = d-
deca- = 10 = da-
hecto- = 100 = h-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
"""

BASE = """
meter = [length] = m = metre = meters = metres
kilogram = [mass] = kg = kilograms = Kg
second = [time] = s = sec = seconds = secs
ampere = [current] = A = amp = amps = amperes
kelvin = [temperature]; offset: 0 = K
degree_Celsius = kelvin; offset: 273.15 = degC = celsius
degree_Fahrenheit = 5 / 9 * kelvin; offset: 233.15 + 200 / 9 = degF = fahrenheit
sample = [sample] = samples = Sa
decibel = [level] = dB
"""

DERIVED = """
gram = 1e-3 * kilogram = g = grams
tonne = 1000 * kilogram = t = metric_ton
pound = 0.45359237 * kilogram = lb = lbs = lbm
standard_gravity = 9.80665 * meter / second ** 2 = g_0 = g_n = gn
newton = kilogram * meter / second ** 2 = N = newtons
pound_force = pound * standard_gravity = lbf
ounce_force = pound_force / 16 = ozf
slug = pound_force * second ** 2 / foot
kip = 1000 * pound_force = kips
gram_force = gram * standard_gravity = gf
kilogram_force = kilogram * standard_gravity = kgf = kilopond = kp
tonne_force = tonne * standard_gravity = tf = tonf
inch = 0.0254 * meter = in = inches
foot = 12 * inch = ft = feet
mil = 1e-3 * inch = thou = mils
micron = 1e-6 * meter
liter = 1e-3 * meter ** 3 = l = L = litre = liters = litres
cc = 1e-6 * meter ** 3
gallon = 231 * inch ** 3 = gal
minute = 60 * second = min = minutes
hour = 3600 * second = h = hours
hertz = 1 / second = Hz
sps = 1 / second
pascal = newton / meter ** 2 = Pa = pascals
bar = 1e5 * pascal
psi = pound_force / inch ** 2
ksi = 1000 * psi
atm = 101325 * pascal = atmosphere
technical_atmosphere = kilogram_force / (1e-2 * meter) ** 2 = at
mmHg = 133.322387415 * pascal
inHg = 3386.388640341 * pascal
millimeter_of_water = 9.80665 * pascal
centimeter_of_water = 98.0665 * pascal
inch_of_water = 249.08891 * pascal
joule = newton * meter = J
watt = joule / second = W
volt = watt / ampere = V = volts
newton_meter = newton * meter = Nm
newton_millimeter = 1e-3 * newton_meter = Nmm
newton_centimeter = 1e-2 * newton_meter = Ncm
newton_second = newton * second = Ns
newton_meter_second = newton_meter * second = Nms
lpm = liter / minute
gpm = gallon / minute
percent = 0.01
counts = 1 = count = ticks = lsb = LSB
radian = 1 = rad
degree = 0.017453292519943295 = deg
revolution = 6.283185307179586 = rev
rpm = revolution / minute
rps = revolution / second
dps = degree / second
"""

ANGLES = frozenset({"radian", "rad", "degree", "deg", "revolution", "rev", "rpm", "rps", "dps", "mrad"})
"""Dimensionless for pint, so that rad/s would pass for Hz and be wrong by 2π."""

_IN_FULL = {
    "meter": "m", "millimeter": "mm", "centimeter": "cm", "micrometer": "um", "micron": "um", "newton": "N",
    "kilonewton": "kN", "pound": "lb", "lb": "lb", "kip": "kip", "kilogram": "kg", "gram": "g", "second": "s",
    "millisecond": "ms", "microsecond": "us", "minute": "min", "hour": "h", "volt": "V", "millivolt": "mV", "amp": "A",
    "milliamp": "mA", "radian": "rad", "degree": "deg", "revolution": "rev", "watt": "W", "pascal": "Pa",
    "kilopascal": "kPa", "liter": "l",
}  # fmt: skip
"""Units in full, as a heading writes them: in the plural too, with a capital letter or in capitals."""
_WORDS = {f"{name}{end}": unit for name, unit in _IN_FULL.items() for end in ("", "s")} | {
    "inch": "in",
    "inches": "in",
    "foot": "ft",
    "feet": "ft",
    "percent": "percent",
    "counts": "counts",
    "celsius": "degC",
    "lbf": "lbf",
}
SPELLINGS = {
    **{way: unit for name, unit in _WORDS.items() for way in (name, name.capitalize(), name.upper())},
    "%": "percent", "°": "deg", "°C": "degC", "°F": "degF", '"': "inch", "hz": "Hz", "HZ": "Hz", "KHz": "kHz",
    "Khz": "kHz", "khz": "kHz", "KN": "kN", "Kn": "kN", "MPA": "MPa", "Mpa": "MPa", "KPa": "kPa", "kpa": "kPa",
    "KPA": "kPa", "PSI": "psi", "Psi": "psi", "KSI": "ksi", "KG": "kg", "IN": "in", "″": "inch", "μm": "µm",
    "rot": "rev", "turn": "rev", "turns": "rev", "tr": "rev", "upm": "rpm", "Upm": "rpm", "U": "rev", "Umdr": "rev",
    "RPM": "rpm", "Rpm": "rpm", "Sec": "s", "SEC": "s", "Sekunden": "s", "Hertz": "Hz", "MM": "mm", "CM": "cm",
    "Bar": "bar", "BAR": "bar", "mBar": "mbar", "LPM": "lpm", "GPM": "gpm", "Ampere": "A",
}  # fmt: skip
"""Ways of writing that leave no doubt about what is meant."""

COMPOUNDS = {
    **{f"{pound}*{length}": f"lbf*{length}" for pound in ("lb", "lbs") for length in ("ft", "in")},
    **{f"{length}*{pound}": f"lbf*{length}" for pound in ("lb", "lbs") for length in ("ft", "in")},
    "mmH2O": "millimeter_of_water",
    "cmH2O": "centimeter_of_water",
    "inH2O": "inch_of_water",
    "oz*in": "ozf*in",
    "in*oz": "ozf*in",
    "r/min": "rev/min",
    "r/s": "rev/s",
    "kgm2": "kg*m^2",
    "kgm^2": "kg*m^2",
}
"""Compounds whose names by themselves are another unit: the pound of a torque is a force, the r of r/min a turn."""
