# mansard in a container. Results belong to whoever runs it; the workbench is reached from this machine only:
#   docker build -t mansard .
#   docker run --rm -u "$(id -u):$(id -g)" -v "$PWD:/work" mansard reconstruct mesh.ply footprints.gpkg -o models
#   docker run --rm -u "$(id -u):$(id -g)" -v "$PWD:/work" -p 127.0.0.1:8642:8642 mansard serve project --address 0.0.0.0
# The first stage goes the way of `make demo`, from a Debian 12 with nothing but make in it, so what it needs is in
# packages.txt and nowhere else; the second has the Debian package made there, and no compiler.
FROM debian:12-slim AS build
RUN apt-get -qq update && apt-get -qq install -y --no-install-recommends make ca-certificates
WORKDIR /mansard
# The set-up comes first: it changes least.
COPY packages.txt ./
COPY tools/setup.sh tools/setup.sh
RUN tools/setup.sh build package
COPY . .
RUN make demo
RUN cmake --build --preset release --target mansard_manual && cd build/release && cpack -G DEB -D CPACK_COMPONENTS_ALL=program

FROM debian:12-slim
COPY --from=build /mansard/build/release/packaging/mansard_*.deb /tmp/
RUN apt-get -qq update && apt-get -qq install -y --no-install-recommends /tmp/mansard_*.deb \
  && rm -rf /var/lib/apt/lists/* /tmp/mansard_*.deb
# Not root, also where no -u is given. The number of the user may be any: temporary files go to /tmp.
RUN useradd --create-home --uid 1000 mansard
USER mansard
ENV HOME=/tmp
EXPOSE 8642
WORKDIR /work
ENTRYPOINT ["mansard"]
CMD ["--help"]
