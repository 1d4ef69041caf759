"""Exact waves of finite strain in a column: what a foot on dashpots and springs, or a fixed one, throws back.

In uniaxial strain, X of the material at rest, stretch l = dx/dX, nominal stress P(l): rho0 dv/dt = dP/dX, dl/dt = dv/dX. With C(l) = sqrt(P'/rho0) and
Phi(l) = integral of C from 1 to l, v - Phi is carried along dX/dt = C, v + Phi along dX/dt = -C (Riemann's invariants: Whitham 1974, chapter 5). A pulse that goes down
into ground at rest has v = -Phi = v_in; what comes back behind it has v = Phi = r; where they meet, v - Phi = 2 v_in and v + Phi = 2 r still. The foot (v positive downwards)
takes P = -Z v - k u with Z = sqrt(rho M), rho = rho0/l of now and M the modulus at the start: one equation for l. With ln l = -e in the ground that comes,
r/v_in = -e (1/4 - m/8) + O(e^2), where P' = M (1 - m ln l): m = 1 for linear-elastic, 5/3 for neo-hookean at nu = 1/4. Invariants are exact; the times at which they arrive leave out
how waves speed each other up where they meet: 1e-4 s in the columns here."""
from bisect import bisect_right
from math import log, sqrt


class Law:
    """Stress of uniaxial strain, Pa, and its slope: sigma = M ln l, as linear-elastic in rate form gives it, or that of neo-hookean."""

    def __init__(self, name, E, nu, density):
        self.mu, self.la, self.density = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu)), density
        self.modulus = self.la + 2 * self.mu
        self.speed = sqrt(self.modulus / density)
        self.neo = {"linear-elastic": False, "neo-hookean": True}[name]

    def stress(self, l):
        return self.mu * (l - 1 / l) + self.la * log(l) / l if self.neo else self.modulus * log(l)

    def slope(self, l):
        return self.mu * (1 + 1 / l**2) + self.la * (1 - log(l)) / l**2 if self.neo else self.modulus / l

    def celerity(self, l):
        return sqrt(self.slope(l) / self.density)

    def invariant(self, l):
        """Phi, m/s: Simpson's rule on 8 pieces; 1e-13 of itself where l is within a few per cent of 1."""
        d = (l - 1) / 8
        return d / 3 * sum(w * self.celerity(1 + i * d) for i, w in enumerate((1, 4, 2, 4, 2, 4, 2, 4, 1)))

    def stretch_under(self, stress):
        l = 1.0
        for _ in range(8):
            l -= (self.stress(l) - stress) / self.slope(l)
        return l

    def stretch_at(self, invariant):
        l = 1.0
        for _ in range(8):
            l -= (self.invariant(l) - invariant) / self.celerity(l)
        return l


def between(times, values, t):
    """Straight lines between the values; 0 outside."""
    i = bisect_right(times, t)
    if i == 0 or i == len(times):
        return 0.0
    a = (t - times[i - 1]) / (times[i] - times[i - 1])
    return values[i - 1] + a * (values[i] - values[i - 1])


class Column:
    """Of one height under pressure(t) at its free top. foot: "viscous", "fixed", or a stiffness k, Pa/m, of springs beside the dashpots. Velocities are positive downwards.
    self.foot: displacement of the foot at self.time."""

    def __init__(self, law, height, pressure, foot, end, dt=1e-4):
        self.law, self.height = law, height
        fixed, k = foot == "fixed", foot if isinstance(foot, float) else 0.0
        self.time = [i * dt for i in range(int(end / dt) + 2)]
        self.down = [-law.invariant(law.stretch_under(-pressure(t))) for t in self.time]
        self.down_speed = [law.celerity(law.stretch_at(-v)) for v in self.down]
        self.up, self.up_speed, self.foot = [], [], []
        arrival = [t + height / c for t, c in zip(self.time, self.down_speed)]
        l, u = 1.0, 0.0
        for t in self.time:
            twice = 2 * between(arrival, self.down, t) + 2 * self.returned(t, dt)
            for _ in range(30):
                v = twice + law.invariant(l)
                z = sqrt(law.density * law.modulus / l)
                miss = v if fixed else law.stress(l) + z * v + k * (u + 0.5 * dt * v)
                step = miss / (law.celerity(l) if fixed else law.slope(l) - 0.5 * z / l * v + (z + 0.5 * k * dt) * law.celerity(l))
                l -= step
                if abs(step) < 1e-14:
                    break
            v = twice + law.invariant(l)
            u += dt * v
            self.foot.append(u)
            self.up.append(0.5 * (v + law.invariant(l)))
            self.up_speed.append(law.celerity(law.stretch_at(self.up[-1])))

    def returned(self, t, dt):
        """What the foot threw back and the free top sends down again."""
        i = (t - 2 * self.height / self.law.speed) / dt
        return self.up[int(i)] if i > 0 else 0.0

    def velocity_at(self, depth):
        """Function of t, m/s, of the material so deep below the top; until what the foot threw back comes from the top."""
        down = [t + depth / c for t, c in zip(self.time, self.down_speed)]
        up = [t + (self.height - depth) / c for t, c in zip(self.time, self.up_speed)]
        return lambda t: between(down, self.down, t) + between(up, self.up, t)
