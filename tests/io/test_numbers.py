"""Numbers out of bytes equal Python's float(), bit for bit."""

from __future__ import annotations

import math
import struct
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
import pytest

from beltrami._jit import kernel
from beltrami.io import decimal, digits, numbers, rounding
from beltrami.io.powers import FIVE_HIGH, FIVE_LOW, SMALLEST

eight = kernel(digits.eight)
nearest = kernel(decimal.nearest)
product = kernel(rounding.product)
read_integer = kernel(numbers.read_integer)
read_number = kernel(numbers.read_number)
scaled = kernel(rounding.scaled)


def parse(text: str) -> float:
    data = np.frombuffer(text.encode(), np.uint8)
    value, position = read_number(data, 0, len(data))
    assert position == len(data), text
    return value


def same_bits(a: float, b: float) -> bool:
    return struct.pack("d", a) == struct.pack("d", b)


def random_doubles(seed: int, count: int) -> list[float]:
    bits = np.random.default_rng(seed).integers(0, 2**64, count, dtype=np.uint64)
    values = bits.view(np.float64)
    return values[np.isfinite(values)].tolist()


@pytest.mark.parametrize("form", ["%r", "%.17g", "%.7g", "%.3e", "%.25e", "%.60f"])
def test_random_doubles(form):
    for x in random_doubles(83_450_217, 4000):
        assert same_bits(parse(form % x), float(form % x)), form % x


def test_random_digits_and_exponents():
    rng = np.random.default_rng(62_003_941)
    for _ in range(6000):
        whole = int.from_bytes(rng.bytes(12)) >> int(rng.integers(6, 96))
        text = f"{whole}.{rng.integers(2**60):0{rng.integers(1, 25)}d}"
        text += f"e{rng.integers(-360, 330)}" if rng.random() < 0.5 else ""
        assert same_bits(parse(text), float(text)), text


def test_half_way_points_and_their_neighbours():
    with localcontext() as context:
        context.prec = 1200
        for x in random_doubles(55_120_733, 400) + [k * 5e-324 for k in range(1, 60)]:
            up = float(np.nextafter(abs(x), math.inf))
            if up == math.inf:
                continue
            middle = f"{(Decimal(abs(x)) + Decimal(up)) / 2:f}"
            middle += "" if "." in middle else ".0"
            for text in (middle, middle + "0" * 800 + "1", middle[:-1] + "4" + "9" * 30):
                assert same_bits(parse(text), float(text)), text


@pytest.mark.parametrize(
    "text",
    [
        "0",
        "-0",
        "0.0",
        ".5",
        "5.",
        "+1",
        "1e400",
        "-1e400",
        "1e-400",
        "inf",
        "-Infinity",
        "1.7976931348623157e308",
        "1.7976931348623158e308",
        "1.7976931348623159e308",
        "2.2250738585072011e-308",
        "2.2250738585072014e-308",
        "4.9e-324",
        "2.4703282292062327e-324",
        "2.4703282292062328e-324",
        "1e-99999999999999999999",
        "0e999999999",
        "9007199254740993",
        "9007199254740992.5",
        "1732802589475821.875",
        "1E5",
        "1e+22",
        "1e23",
        "1e0000000000000005",
        "18446744073709551616",
        "99999999999999999999",
        "123456789012345678901234567890e-30",
    ],
)
def test_special_numbers(text):
    assert same_bits(parse(text), float(text))


@pytest.mark.parametrize(
    "text", ["0" * 3000 + "1e-3", "0." + "0" * 400 + "1e400", "1" + "0" * 400 + "e-400", "9" * 900]
)
def test_long_numbers(text):
    assert same_bits(parse(text), float(text))


@pytest.mark.parametrize("end", ["", "1"])
def test_ties_of_millions_of_digits(end):
    text = "9007199254740993." + "0" * (17 << 20) + end
    assert same_bits(parse(text), 9007199254740994.0 if end else 9007199254740992.0)


def test_nan():
    assert math.isnan(parse("nan"))
    assert math.isnan(parse("-NaN"))


@pytest.mark.parametrize(
    "text",
    ["", "-", ".", "e5", "1e", "1e+", "1.2.3", "0x10", "1,5", "nano", "in", "infinit", "1_0", "١"],
)
def test_no_numbers(text):
    data = np.frombuffer(text.encode() + b" ", np.uint8)
    assert read_number(data, 0, len(data)) == (0.0, 0)


def test_the_end_of_the_buffer_is_respected():
    data = np.frombuffer(b"12345678901234567890", np.uint8)
    for end in range(1, 20):
        assert read_number(data, 0, end) == (float(data[:end].tobytes()), end)
        assert read_integer(data, 0, end)[1] == (end if end <= 18 else 0)


def test_the_slow_way_alone_gives_the_same():
    """Between other digits, which are no part of the number."""
    for x in random_doubles(29_914_006, 300):
        text = f"{abs(x):.30e}"
        data = np.frombuffer(f"99{text}99".encode(), np.uint8)
        assert nearest(data, 2, len(data) - 2) == float(text)


def test_the_slow_way_in_threads_beside_python():
    """It takes Python's lock, which the kernel has let go."""
    text = "4.9e-324 2.4703282292062328e-324 9007199254740993.0000000000000000001"
    data = np.frombuffer(text.encode(), np.uint8)
    places = [(0, 8), (9, 32), (33, len(text))]
    expected = [float(word) for word in text.split()]

    def read(_):
        return [nearest(data, *place) for place in places for _ in range(50)]

    with ThreadPoolExecutor(8) as pool:
        for found in pool.map(read, range(40)):
            assert found == [x for x in expected for _ in range(50)]


def test_products_of_words():
    rng = np.random.default_rng(71_233_009)
    for a, b in rng.integers(0, 2**64, (200, 2), dtype=np.uint64):
        high, low = product(a, b)
        assert (int(high) << 64) + int(low) == int(a) * int(b)


def test_powers_of_five_are_cut_or_rounded_up():
    for q in (-342, -28, -27, -1, 0, 1, 27, 55, 56, 308):
        word = (int(FIVE_HIGH[q - SMALLEST]) << 64) + int(FIVE_LOW[q - SMALLEST])
        assert word.bit_length() == 128
        exact = Fraction(5) ** q
        unit = Fraction(2) ** (exact.numerator.bit_length() - exact.denominator.bit_length() - 127)
        error = min((word * u - exact) / u for u in (unit, unit / 2) if abs(word * u - exact) < u)
        assert (error > 0) == (-27 <= q < 0)


def test_scaled_leaves_the_subnormal_range_open():
    assert math.isnan(scaled(np.uint64(5), -324))
    assert scaled(np.uint64(5), -343) == 0.0
    assert scaled(np.uint64(5), 309) == math.inf


@pytest.mark.parametrize("count", range(9))
@pytest.mark.parametrize("after", [0, 9, 32, 47, 58, 127, 128, 185, 186, 255])
def test_eight_digits(count, after):
    data = np.full(8, after, np.uint8)
    data[:count] = np.frombuffer(b"98765432", np.uint8)[:count]
    data[count + 1 :] = 48 + 7  # digits after the byte that ends the number
    value, found = eight(data, 0)
    assert (int(value), int(found)) == (int(b"98765432"[:count] or b"0"), count)


@pytest.mark.parametrize(("text", "value"), [("7", 7), ("-12/3", -12), ("+4 ", 4), ("0012", 12)])
def test_integers(text, value):
    data = np.frombuffer(text.encode(), np.uint8)
    assert read_integer(data, 0, len(data)) == (value, len(text.rstrip(" /3") or text))


def test_no_integers():
    for text in ("", "-", "x", "1" * 19):
        data = np.frombuffer(text.encode(), np.uint8)
        assert read_integer(data, 0, len(data)) == (0, 0)
