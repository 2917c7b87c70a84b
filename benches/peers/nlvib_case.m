% lumped24, pattern 0, in NLvib under GNU Octave: processor time of its curve and of its peak, as `name = value`.
%
% Run by run.py: octave-cli nlvib_case.m FOLDER_OF_THE_CASE REPETITIONS FOLDER_OF_NLVIB.
1;

function matrix = read_matrix(path)
  % A real general matrix in Matrix Market coordinates.
  lines = strsplit(strtrim(fileread(path)), "\n");
  lines = lines(! strncmp(lines, "%", 1));
  entries = sscanf(strjoin(lines, " "), "%f", [3, Inf]).';
  matrix = full(sparse(entries(2:end, 1), entries(2:end, 2), entries(2:end, 3), entries(1, 1), entries(1, 2)));
end

function values = all_of(text, key)
  found = regexp(text, ["^" key " = ([-+.0-9e]+)"], "tokens", "lineanchors");
  values = cellfun(@(token) str2double(token{1}), found);
end

function case_ = read_case(folder)
  text = fileread(fullfile(folder, "case.toml"));
  M = read_matrix(fullfile(folder, "M.mtx"));
  D = read_matrix(fullfile(folder, "C.mtx"));
  K = read_matrix(fullfile(folder, "K.mtx"));
  mistuning = dlmread(fullfile(folder, "mistuning.csv"), ",", 1, 0);
  for row = mistuning(mistuning(:, 1) == 0, :).'
    dofs = 3 * row(2) + [1, 2];
    K(dofs, dofs) += all_of(text, "k_blade") * row(3) * [1, -1; -1, 1];
  end
  force = dlmread(fullfile(folder, "force.csv"), ",", 1, 0);
  % NLvib has Re(F exp(i Om t)) too.
  Fex1 = zeros(rows(M), 1);
  Fex1(force(:, 1) + 1) = force(:, 2) + 1i * force(:, 3);
  a = all_of(text, "dof_a"); b = all_of(text, "dof_b");
  k = all_of(text, "k_t"); limit = all_of(text, "slip_limit");
  case_.stuck = K;
  elements = cell(1, numel(a));
  for number = 1:numel(a)
    w = zeros(rows(M), 1);
    w(a(number) + 1) = 1;
    w(b(number) + 1) = -1;
    elements{number} = struct("type", "elasticDryFriction", "stiffness", k(number), ...
        "friction_limit_force", limit(number), "ishysteretic", true, "force_direction", w);
    case_.stuck += k(number) * (w * w.');
  end
  case_.system = MechanicalSystem(M, D, K, elements, Fex1);
  case_.samples = all_of(text, "samples_per_period");
  case_.reference = dlmread(fullfile(folder, "ref_p0_h3.csv"), ",", 2, 0);
  case_.force_norm = norm(Fex1);
  case_.H = 3;  % NLvib has all harmonics up to the highest
end

function [R, dR] = equations(case_, scaled, Om)
  % As `extended_residual` of NLvib has them at a fixed frequency: unknowns and residual of order 1.
  [R, dR] = HB_residual([scaled * case_.scale; Om], case_.system, case_.H, case_.samples, "frf");
  R /= case_.force_norm;
  dR = dR(:, 1:end-1) * (case_.scale / case_.force_norm);
end

function [x, met] = by_newton(case_, x, Om)
  met = false;
  for iteration = 0:12
    [R, dR] = equations(case_, x, Om);
    met = norm(R) <= case_.tolerance;
    if met || iteration == 12
      break;
    end
    x -= dR \ R;
  end
end

function [x, met] = by_fsolve(case_, x, Om)
  options = optimset(optimset("fsolve"), "Display", "off", "Jacobian", "on", "MaxIter", 50, "TolFun", 1e-14, ...
      "TolX", 1e-14, "Updating", case_.updating);
  [x, R] = fsolve(@(y) equations(case_, y, Om), x, options);
  met = norm(R) <= case_.tolerance;
end

function x = first(case_, Om)
  % The linear response with stuck contacts.
  system = case_.system;
  response = (case_.stuck - Om ^ 2 * system.M + 1i * Om * system.D) \ system.Fex1;
  n = system.n;
  x = zeros(n * (2 * case_.H + 1), 1);
  x(n+1:3*n) = [real(response); -imag(response)] / case_.scale;
end

function [points, x] = solve(case_, points, Om, depth = 0)
  % Each solver from the secant through the nearest two points, else from the nearest; where none converges, a point
  % between is solved first. A point is the scaled unknowns and, last, the circular frequency.
  if isempty(points)
    starts = first(case_, Om);
  else
    [~, order] = sort(abs(points(end, :) - Om));
    a = points(:, order(1));
    starts = a(1:end-1);
    if columns(points) > 1
      b = points(:, order(2));
      starts = [a(1:end-1) + (Om - a(end)) / (a(end) - b(end)) * (a(1:end-1) - b(1:end-1)), starts];
    end
  end
  for solver = case_.solvers
    for start = starts
      [x, met] = solver{1}(case_, start, Om);
      if met
        points(:, end+1) = [x; Om];
        return;
      end
    end
  end
  if depth == 6 || isempty(points)
    error("no solution at %g Hz", Om / (2 * pi));
  end
  points = solve(case_, points, 0.5 * (Om + a(end)), depth + 1);
  [points, x] = solve(case_, points, Om, depth + 1);
end

function found = amplitudes(case_, x)
  % Largest value over a period at every blade, m.
  instants = (0:1023) * 2 * pi / 1024;
  blocks = reshape(x, case_.system.n, []) * case_.scale;
  motion = blocks(:, 1) * ones(1, 1024);
  for h = 1:case_.H
    motion += blocks(:, 2*h) * cos(h * instants) + blocks(:, 2*h+1) * sin(h * instants);
  end
  found = max(abs(motion(1:3:end, :)), [], 2).';
end

function [points, height] = height_of(case_, points, frequency)
  [points, x] = solve(case_, points, 2 * pi * frequency);
  height = max(amplitudes(case_, x));
end

function [best, height, solves] = peak(case_)
  % The search of wheel.py: steps of 1 Hz, then parabolas through the three highest neighbours.
  case_.tolerance = 1e-6;
  at = case_.reference(1, 1):case_.reference(end, 1);
  heights = zeros(size(at));
  points = [];
  for number = 1:numel(at)
    [points, heights(number)] = height_of(case_, points, at(number));
  end
  while true
    [height, top] = max(heights);
    best = at(top);
    three = at(top-1:top+1);
    fit = polyfit(three - best, heights(top-1:top+1), 2);
    next = best - fit(2) / (2 * fit(1));
    expected = fit(3) - fit(2) ^ 2 / (4 * fit(1));
    if abs(expected / height - 1) < 1e-4 && three(3) - three(1) < 0.6
      solves = numel(at);
      return;
    end
    if min(abs(next - three)) < 0.05
      if three(3) - best > best - three(1)
        next = best + 0.5 * (three(3) - best);
      else
        next = best - 0.5 * (best - three(1));
      end
    end
    [points, added] = height_of(case_, points, next);
    [at, order] = sort([at, next]);
    heights = [heights, added](order);
  end
end

function main(folder, repetitions, nlvib)
  addpath(fullfile(nlvib, "SRC"), fullfile(nlvib, "SRC", "MechanicalSystems"));
  case_ = read_case(folder);
  case_.scale = 1e-5;
  case_.tolerance = 1e-8;
  case_.updating = "off";
  case_.solvers = {@by_newton, @by_fsolve};
  frequencies = case_.reference(:, 1).';
  least = Inf;
  for repetition = 1:repetitions
    before = cputime();
    points = [];
    curve = zeros(case_.system.n * (2 * case_.H + 1), numel(frequencies));
    for at = 1:numel(frequencies)
      [points, curve(:, at)] = solve(case_, points, 2 * pi * frequencies(at));
    end
    least = min(least, cputime() - before);
  end
  worst = 0;
  for at = 1:numel(frequencies)
    worst = max(worst, max(abs(amplitudes(case_, curve(:, at)) ./ case_.reference(at, 2:end) - 1)));
  end
  if worst > 1e-6
    error("worst blade %g", worst);
  end
  printf("curve_s = %.3f\ncurve_difference = %e\ncurve_solves = %d\n", least, worst, columns(points));
  least = Inf;
  for repetition = 1:repetitions
    before = cputime();
    [frequency, height, solves] = peak(case_);
    least = min(least, cputime() - before);
  end
  highest = height;
  for around = frequency + (-0.1:0.05:0.1)
    [points, other] = height_of(case_, points, around);
    highest = max(highest, other);
  end
  if abs(height / highest - 1) > 1e-3
    error("peak %g, highest %g", height, highest);
  end
  printf("peak_s = %.3f\npeak_hz = %.6f\npeak_m = %e\npeak_solves = %d\npeak_difference = %e\n", ...
      least, frequency, height, solves, abs(height / highest - 1));
end

arguments = argv();
main(arguments{1}, str2double(arguments{2}), arguments{3});
