#!/bin/sh
# The service in a container of the image, in place of the binary: the tests of tests/api start it as REFLECTANCE_SERVER.
# On the machine's own network, and with its /tmp, where tests put certificates and keys.
exec podman --runtime runc --cgroup-manager cgroupfs --log-level error run --rm --label reflectance=test --no-healthcheck \
    --network host --read-only --cap-drop all --security-opt no-new-privileges \
    --ulimit nofile=4096:4096 --ulimit nproc=4096:4096 \
    --volume /tmp:/tmp:ro --env REFLECTANCE_LOG_LEVEL --env REFLECTANCE_LOG_FORMAT=human localhost/reflectance "$@"
