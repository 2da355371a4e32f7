% fsolve on the paper's equations, Jacobian by differences: chain_model.py's
% Chain.model in Octave. Called with the folder of chain.json; leaves
% octave.json. Forward only.
1;

function [turn, ends] = places(chain, theta)
  turn = [0; cumsum(theta)];
  c = cos(turn); s = sin(turn);
  x = chain.steps(:, 1); y = chain.steps(:, 2);
  ends = cumsum([c .* x - s .* y, s .* x + c .* y], 1);
end

% Where a point of a link (with so many joints before) is, and lies at rest.
function point = at(chain, turn, ends, link, rest)
  start = [0, 0]; origin = [0, 0];
  if link > 0
    start = ends(link, :); origin = chain.joints(link, :);
  end
  c = cos(turn(link + 1)); s = sin(turn(link + 1));
  d = rest - origin;
  point = start + [c * d(1) - s * d(2), s * d(1) + c * d(2)];
end

function torque = push(torque, joints, before, place, force)
  arm = place - joints(1:before, :);
  torque(1:before) -= arm(:, 1) * force(2) - arm(:, 2) * force(1);
end

function residual = model(chain, unknowns, contact, force, friction)
  n = chain.n; r = numel(chain.rib_length);
  theta = unknowns(1:n); wrench = unknowns(n + 1:n + 3);
  ribs = unknowns(n + 4:n + 3 + r);
  [turn, ends] = places(chain, theta);
  joints = ends(1:n, :);
  torque = chain.stiffness .* theta;
  distance = zeros(r, 1);
  for k = 1:r
    left = at(chain, turn, ends, chain.left_link(k), chain.left_rest(k, :));
    right = at(chain, turn, ends, chain.right_link(k), chain.right_rest(k, :));
    across = left - right;
    distance(k) = norm(across);
    pushing = ribs(k) * across / distance(k);
    torque = push(torque, joints, chain.left_link(k), left, pushing);
    torque = push(torque, joints, chain.right_link(k), right, -pushing);
  end
  link = sum(chain.front_mid < contact);
  angle = pi / 2 + turn(link + 1);
  place = at(chain, turn, ends, link, [0, contact]);
  along = [cos(angle), sin(angle)];
  load = force * ([along(2), -along(1)] + friction * along);
  torque = push(torque, joints, link, place, load);
  arm = ends(end, :) - joints;
  torque -= wrench(1) + arm(:, 1) * wrench(3) - arm(:, 2) * wrench(2);
  residual = [turn(end); ends(end, :)' - chain.last(:); torque; ...
              distance - chain.rib_length];
end

folder = argv(){1};
job = jsondecode(fileread([folder '/chain.json']));
options = optimset('TolX', 1e-10, 'TolFun', 1e-12, 'MaxIter', 400);
spent = 0; solutions = {};
for k = 1:numel(job.loads)
  load = job.loads(k);
  begin = tic;
  % From the straight finger; by shares of the load where that fails.
  for steps = [1, 4, 16]
    x = zeros(job.chain.n + 3 + numel(job.chain.rib_length), 1); count = 0;
    for share = (1:steps) / steps
      f = @(u) model(job.chain, u, load.contact, share * load.force, load.friction);
      [x, value, info, output] = fsolve(f, x, options);
      count += output.iterations;
    end
    solved = max(abs(value)) < 1e-6;
    if solved, break; end
  end
  spent += toc(begin);
  solutions{k} = struct('x', x, 'iterations', count, 'solved', solved);
end
file = fopen([folder '/octave.json'], 'w');
fputs(file, jsonencode(struct('version', version(), 'seconds', spent, 'solutions', {solutions})));
fclose(file);
