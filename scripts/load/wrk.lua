-- The request comes from the environment; the figures leave as one line of JSON.
-- LOAD_PAUSE is the milliseconds that a connection waits between requests: each wait is drawn from 0 to twice that.

wrk.method = os.getenv("LOAD_METHOD") or "GET"
wrk.body = os.getenv("LOAD_BODY")
for name, value in (os.getenv("LOAD_HEADERS") or ""):gmatch("([^:\n]+): ([^\n]+)") do
  wrk.headers[name] = value
end

local pause = tonumber(os.getenv("LOAD_PAUSE") or "0")
if pause > 0 then
  function delay()
    return math.random(0, 2 * pause)
  end
end

function done(summary, latency)
  local errors = summary.errors
  io.write(string.format(
    '\n{"requests":%d,"seconds":%.6f,"refused":%d,"broken":%d,"p50":%.1f,"p90":%.1f,"p99":%.1f,"largest":%.1f}\n',
    summary.requests, summary.duration * 1e-6, errors.status,
    errors.connect + errors.read + errors.write + errors.timeout,
    latency:percentile(50), latency:percentile(90), latency:percentile(99), latency.max))
end
