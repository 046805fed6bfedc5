#!/usr/bin/env python3
"""Reference states of the discrete motions in tests/oracle/src/reference, computed from the equations alone.

    python3 tests/reference/generate.py > tests/reference/states.txt

The script needs only Python 3 and half a minute; it computes with fifty decimal digits of the module `decimal`. The tests do
not run it, but compare the tables with the committed output. It shares no code with the program: every step solves the
discrete equations, stated in matrices below, by Newton's method with a difference tangent, from the previous solution.

Each line is a state: name of the table, index in it, numbers row by row, 32 significant digits.
"""

from decimal import Decimal, getcontext

getcontext().prec = 50
D = Decimal
ZERO, ONE, TWO = D(0), D(1), D(2)
NODES = (1, 10, 100, 1000)
H = D("0.1")
# Newton's method stops when a correction is below DONE; the difference tangent over SMALL is accurate to its size.
SMALL, DONE = D("1e-25"), D("1e-42")


def vector(*entries):
    return [D(str(x)) for x in entries]


def diagonal(entries):
    return [[x if i == j else ZERO for j in range(3)] for i, x in enumerate(entries)]


IDENTITY = diagonal([ONE] * 3)


def dot(a, b):
    return sum((x * y for x, y in zip(a, b)), ZERO)


def apply(a, v):
    return [dot(row, v) for row in a]


def transposed(a):
    return [list(column) for column in zip(*a)]


def product(a, b):
    columns = transposed(b)
    return [[dot(row, column) for column in columns] for row in a]


def plus(a, b, factor=ONE):
    """a + factor b, of vectors or of matrices."""
    if isinstance(a, list):
        return [plus(x, y, factor) for x, y in zip(a, b)]
    return a + factor * b


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def hat(v):
    x, y, z = v
    return [[ZERO, -z, y], [z, ZERO, -x], [-y, x, ZERO]]


def axial(a):
    """The vector of a - a^T."""
    return [a[2][1] - a[1][2], a[0][2] - a[2][0], a[1][0] - a[0][1]]


def trace(a):
    return a[0][0] + a[1][1] + a[2][2]


def determinant(a):
    return dot(a[0], cross(a[1], a[2]))


def quaternion(q):
    """The unit quaternion with this vector part and a positive real part."""
    return [(ONE - dot(q, q)).sqrt(), *q]


def rotation(q):
    """Id + 2 w hat(q) + 2 hat(q)^2."""
    w, q = q[0], q[1:]
    k = hat(q)
    return plus(plus(IDENTITY, k, TWO * w), product(k, k), TWO)


def times(p, q):
    a, u, b, v = p[0], p[1:], q[0], q[1:]
    return [a * b - dot(u, v), *plus(plus(cross(u, v), v, a), u, b)]


def solve(matrix, right):
    """Gaussian elimination with pivots."""
    n = len(right)
    rows = [list(row) + [x] for row, x in zip(matrix, right)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [x - factor * y for x, y in zip(rows[k], rows[i])]
    out = [ZERO] * n
    for i in reversed(range(n)):
        out[i] = (rows[i][n] - dot(rows[i][i + 1 : n], out[i + 1 :])) / rows[i][i]
    return out


def newton(residual, start):
    x = list(start)
    for _ in range(30):
        value = residual(x)
        columns = []
        for i in range(len(x)):
            moved = list(x)
            moved[i] += SMALL
            columns.append([(a - b) / SMALL for a, b in zip(residual(moved), value)])
        correction = solve(transposed(columns), value)
        x = plus(x, correction, -ONE)
        if max(map(abs, correction)) < DONE:
            return x
    raise ArithmeticError("no solution near the last one")


class MoserVeselov:
    """The rotation O near the identity with O J - J O^T = h hat(n)."""

    def __init__(self):
        self.last = [ZERO] * 3

    def __call__(self, poinsot, h, momentum):
        right = [h * x for x in momentum]

        def residual(q):
            return plus(axial(product(rotation(quaternion(q)), poinsot)), right, -ONE)

        self.last = newton(residual, self.last)
        return rotation(quaternion(self.last))


def write(name, place, numbers):
    def flat(x):
        return [y for part in x for y in flat(part)] if isinstance(x, list) else [x]

    # Numbers that are zero up to the last of the fifty digits are written as zero.
    print(name, place, *(f"{x:.31e}" if abs(x) > DONE else "0" for x in flat(numbers)))


def inputs(table, **numbers):
    """The initial values of a run, so that they are compared too."""
    for name, value in numbers.items():
        write(f"{table}.{name}", 0, value)


def poinsot(moments):
    half = sum(moments, ZERO) / TWO
    return [half - i for i in moments]


def top_steps(moments, arm, attitude, momentum, h, steps):
    """The body with weight `arm` (zero for a free body) in body axes, with half of the kick before and after the rotation."""
    j, turn = diagonal(poinsot(moments)), MoserVeselov()
    vertical = attitude[2]
    for _ in range(steps):
        edge = plus(momentum, cross(vertical, arm), h / TWO)
        omega = turn(j, h, edge)
        back = transposed(omega)
        vertical = apply(back, vertical)
        momentum = plus(apply(back, edge), cross(vertical, arm), h / TWO)
        attitude = product(attitude, omega)
        yield omega, momentum, vertical, attitude


def free_symmetric():
    moments, start = vector(2, 2, 1), vector(0.1, 0, 1)
    run = top_steps(moments, [ZERO] * 3, IDENTITY, start, H, 1000)
    inputs("body_sym", J=poinsot(moments), M0=start)
    write("body_sym.ENERGY", 0, dot(start, [m / i for m, i in zip(start, moments)]) / TWO)
    for k, (omega, momentum, _, attitude) in enumerate(run, 1):
        if k == 1:
            write("body_sym.OMEGA_1", 0, omega)
        if k in NODES:
            write("body_sym.MOMENTUM", NODES.index(k), momentum)
            write("body_sym.ATTITUDE", NODES.index(k), attitude)
    # M' = M x I^-1 M: the part across the axis turns at the rate M3 (1/I1 - 1/I3).
    rate = start[2] * (ONE / moments[0] - ONE / moments[2])
    sine, cosine = sine_cosine(rate * D(100))
    write("body_sym.CONTINUOUS_MOMENTUM_AT_100", 0, [start[0] * cosine, start[0] * sine, start[2]])


def sine_cosine(angle):
    """Taylor's series of an angle halved until it is small."""
    halvings = 0
    while abs(angle) > D("0.01"):
        angle, halvings = angle / TWO, halvings + 1
    sine = cosine = ZERO
    term, k = ONE, 0
    while abs(term) > D("1e-60"):
        sign = -ONE if k % 4 > 1 else ONE
        sine, cosine = (sine + sign * term, cosine) if k % 2 else (sine, cosine + sign * term)
        k += 1
        term = term * angle / D(k)
    for _ in range(halvings):
        sine, cosine = TWO * sine * cosine, cosine * cosine - sine * sine
    return sine, cosine


def steady():
    moments, start = vector(2, 2, 1), vector(0, 0, 1)
    # The angle with I3 sin(angle) = h M3.
    wanted = H * start[2] / moments[2]
    angle = wanted
    for _ in range(8):
        sine, cosine = sine_cosine(angle)
        angle -= (sine - wanted) / cosine
    inputs("steady_rotation", J=poinsot(moments))
    write("steady_rotation.ANGLE", 0, angle)
    *_, momentum = (m for _, m, _, _ in top_steps(moments, [ZERO] * 3, IDENTITY, start, H, 10))
    write("steady_rotation.M0", 0, momentum)


def lagrange():
    moments, arm, up, start = vector(2, 2, 1), vector(0, 0, 1), vector(0, 0, 1), vector(0.1, 0, 1)
    tilted = [vector(0.8, 0, 0.6), vector(0, 1, 0), vector(-0.6, 0, 0.8)]

    inputs("top_lagrange", J=poinsot(moments), WEIGHT=arm, UP=up, M0=start, ATTITUDE_0=tilted)

    def energy(momentum, vertical):
        return dot(momentum, [m / i for m, i in zip(momentum, moments)]) / TWO + dot(arm, vertical)

    first = energy(start, tilted[2])
    write("top_lagrange.ENERGY_0", 0, first)
    write("top_lagrange.AREA", 0, dot(start, tilted[2]))
    deviations = [ZERO]
    for k, (_, momentum, vertical, attitude) in enumerate(top_steps(moments, arm, tilted, start, H, 1000), 1):
        deviations.append(energy(momentum, vertical) - first)
        if k in NODES:
            write("top_lagrange.MOMENTUM", NODES.index(k), momentum)
            write("top_lagrange.VERTICAL", NODES.index(k), vertical)
            write("top_lagrange.ATTITUDE", NODES.index(k), attitude)
    write("top_lagrange.ENERGY_DEVIATION", 0, [min(deviations), max(deviations)])

    # In space: the Poinsot matrix and the arm are advected, and the vertical is fixed.
    turn = MoserVeselov()
    j = product(product(tilted, diagonal(poinsot(moments))), transposed(tilted))
    momentum, carried = apply(tilted, start), apply(tilted, arm)
    for k in range(1, 1001):
        edge = plus(momentum, cross(up, carried), H / TWO)
        omega = turn(j, H, edge)
        j = product(product(omega, j), transposed(omega))
        carried = apply(omega, carried)
        momentum = plus(edge, cross(up, carried), H / TWO)
        if k in NODES:
            write("top_lagrange.SPATIAL_MOMENTUM", NODES.index(k), momentum)
            write("top_lagrange.SPATIAL_ARM", NODES.index(k), carried)

    # One-sided: N_{k+1} = O_k^T N_k + h Gamma_k x gU with N_1 given.
    turn, j = MoserVeselov(), diagonal(poinsot(moments))
    edge, vertical = start, tilted[2]
    for k in range(1, 1001):
        back = transposed(turn(j, H, edge))
        vertical = apply(back, vertical)
        edge = plus(apply(back, edge), cross(vertical, arm), H)
        if k in NODES:
            write("top_lagrange.ONE_SIDED_MOMENTUM", NODES.index(k), edge)
            write("top_lagrange.ONE_SIDED_VERTICAL", NODES.index(k), vertical)


def spatial():
    moments, body = vector(3.5, 2.5, 2), vector(-0.5, 0, 1)
    place = vector(0.1, -0.3, 0.2)
    inputs("spatial", MOMENTS=moments, BODY_M0=body, QUATERNION_0=place)
    attitude = rotation(quaternion(place))
    j = product(product(attitude, diagonal(poinsot(moments))), transposed(attitude))
    momentum, turn = apply(attitude, body), MoserVeselov()
    square = product(j, j)
    write("spatial.M0", 0, momentum)
    write("spatial.J0", 0, j)
    write("spatial.INVARIANTS", 0, [trace(j), trace(square), determinant(j)])
    for k in range(1, 1001):
        omega = turn(j, H, momentum)
        j = product(product(omega, j), transposed(omega))
        attitude = product(omega, attitude)
        if k in NODES:
            write("spatial.POINSOT", NODES.index(k), j)
            write("spatial.ATTITUDE", NODES.index(k), attitude)
            write("spatial.OMEGA", NODES.index(k), omega)


def quaternions(c, name):
    """h N / 2 = c Q + w (I - c) Q + Q x (I - c) Q in the vector part Q of the step's quaternion."""
    moments, momentum = vector(1, 1, 0.5), vector(-0.5, 0.1, 0.5)
    attitude, last = [ONE, ZERO, ZERO, ZERO], [ZERO] * 3
    if c == ZERO:
        inputs("quaternion", MOMENTS=moments, M0=momentum)
    for k in range(1, 1001):

        def residual(q):
            less = [(i - c) * x for i, x in zip(moments, q)]
            value = plus(plus(cross(q, less), less, quaternion(q)[0]), q, c)
            return plus(value, momentum, -H / TWO)

        last = newton(residual, last)
        step = quaternion(last)
        momentum = apply(transposed(rotation(step)), momentum)
        attitude = times(attitude, step)
        if k in NODES:
            write(f"quaternion.QUATERNION_{name}", NODES.index(k), attitude)
            write(f"quaternion.MOMENTUM_{name}", NODES.index(k), momentum)


def coupled():
    """Two bodies with a joint; R is body 2 seen from body 1, v = R (O2 - 1) d, w = R^T (O1 - 1) d."""
    moments, arm, eps = vector(2, 2, 1), vector(0, 0, 1), D("0.5")
    quarter = [vector(1, 0, 0), vector(0, 0, -1), vector(0, 1, 0)]
    outer = [[x * y for y in arm] for x in arm]
    j = plus(diagonal(poinsot(moments)), outer, eps)
    momenta = [vector(0.5, 0, 1), vector(0.5, 0, 1)]
    attitudes, last = [IDENTITY, quarter], [ZERO] * 6
    inputs("coupled_sym", MOMENTS=moments, ARM=arm, EPS=eps, M0=momenta[0], ATTITUDE_0=quarter)

    def turns(x):
        return rotation(quaternion(x[:3])), rotation(quaternion(x[3:]))

    def arms(relative, one, two):
        moved = [plus(apply(omega, arm), arm, -ONE) for omega in (one, two)]
        return apply(relative, moved[1]), apply(transposed(relative), moved[0])

    def energy(relative):
        bend = hat(arm)
        own = plus(diagonal(moments), product(bend, bend), -eps)
        mixed = product(product(transposed(bend), relative), bend)
        mixed = [[-eps * x for x in row] for row in mixed]
        mass = [a + b for a, b in zip(own, mixed)] + [a + b for a, b in zip(transposed(mixed), own)]
        both = momenta[0] + momenta[1]
        return dot(both, solve(mass, both)) / TWO

    def total():
        return plus(apply(attitudes[0], momenta[0]), apply(attitudes[1], momenta[1]))

    first = energy(quarter)
    write("coupled_sym.ENERGY_0", 0, first)
    write("coupled_sym.TOTAL_MOMENTUM", 0, total())
    write("coupled_sym.CASIMIR", 0, dot(total(), total()))
    deviations = [ZERO]
    for k in range(1, 1001):
        relative = product(transposed(attitudes[0]), attitudes[1])

        def residual(x):
            one, two = turns(x)
            v, w = arms(relative, one, two)
            left = [plus(axial(product(o, j)), cross(arm, u), -eps) for o, u in ((one, v), (two, w))]
            return [a - H * m for a, m in zip(left[0] + left[1], momenta[0] + momenta[1])]

        last = newton(residual, last)
        one, two = turns(last)
        v, w = arms(relative, one, two)
        for i, (omega, u) in enumerate(((one, v), (two, w))):
            new = plus(axial(product(j, omega)), cross(arm, apply(transposed(omega), u)), -eps)
            momenta[i] = [x / H for x in new]
            attitudes[i] = product(attitudes[i], omega)
        relative = product(transposed(attitudes[0]), attitudes[1])
        deviations.append(energy(relative) - first)
        if k in NODES:
            write("coupled_sym.FIRST_MOMENTUM", NODES.index(k), momenta[0])
            write("coupled_sym.SECOND_MOMENTUM", NODES.index(k), momenta[1])
            write("coupled_sym.RELATIVE_ATTITUDE", NODES.index(k), relative)
            write("coupled_sym.FIRST_ATTITUDE", NODES.index(k), attitudes[0])
    write("coupled_sym.ENERGY_DEVIATION", 0, [min(deviations), max(deviations)])


def continuous(moments, momentum, time):
    """The attitude after M' = M x I^-1 M, R' = R hat(I^-1 M), by Taylor's series in pieces."""
    attitude, pieces, terms = IDENTITY, 80, 40
    h = time / D(pieces)
    for _ in range(pieces):
        m, r = [momentum], [attitude]
        for k in range(terms):
            dm, dr = [ZERO] * 3, [[ZERO] * 3] * 3
            for i in range(k + 1):
                w = [x / y for x, y in zip(m[k - i], moments)]
                dm = plus(dm, cross(m[i], w))
                dr = plus(dr, product(r[i], hat(w)))
            m.append([x / D(k + 1) for x in dm])
            r.append([[x / D(k + 1) for x in row] for row in dr])
        momentum, attitude = m[terms], r[terms]
        for a, b in zip(reversed(m[:terms]), reversed(r[:terms])):
            momentum, attitude = plus(a, momentum, h), plus(b, attitude, h)
    return attitude


def asymmetric():
    moments, start, time = vector(3.5, 2.5, 2), vector(-0.5, 0, 1), D(10)
    exact = continuous(moments, start, time)
    for place, steps in enumerate((50, 100, 200, 400, 800)):
        *_, end = (a for *_, a in top_steps(moments, [ZERO] * 3, IDENTITY, start, time / D(steps), steps))
        write("asymmetric_body_errors.ATTITUDE", place, max(abs(x) for row in plus(end, exact, -ONE) for x in row))


if __name__ == "__main__":
    free_symmetric()
    steady()
    lagrange()
    spatial()
    quaternions(ZERO, "C0")
    quaternions(ONE, "C1")
    coupled()
    asymmetric()
