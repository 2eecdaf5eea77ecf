// Shows fields on a surface: turn it with the mouse, move through time with the slider. Needs THREE
// and THREE.OrbitControls; `traceraftScene` describes what there is.
(function () {
  'use strict';
  const scene = window.traceraftScene;
  const box = document.getElementById('viewer');
  const slider = document.getElementById('time');
  const label = document.getElementById('time-label');
  const play = document.getElementById('play');
  const through = document.getElementById('through');

  async function bytesOf(id) {
    const text = document.getElementById(id).textContent.trim();
    const packed = Uint8Array.from(atob(text), (ch) => ch.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Response(stream).arrayBuffer();
  }

  // Rafts are opaque and the rest is a veil, so that those on the far side are seen, too.
  function material(side, paleness) {
    return new THREE.ShaderMaterial({
      side: side,
      transparent: true,
      depthWrite: false,
      uniforms: {veil: {value: 0.3}, paleness: {value: paleness},
                 differences: {value: Boolean(scene.differences)}},
      vertexShader: `
        attribute float value;
        varying float share;
        varying vec3 direction;
        void main() {
          share = value;
          direction = normalMatrix * normal;
          gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        }`,
      fragmentShader: `
        uniform float veil, paleness;
        uniform bool differences;
        varying float share;
        varying vec3 direction;
        void main() {
          vec3 dark = vec3(38.0, 70.0, 120.0) / 255.0, bright = vec3(247.0, 193.0, 82.0) / 255.0;
          float light = 0.55 + 0.45 * abs(dot(normalize(direction), normalize(vec3(-0.4, 0.5, 1.0))));
          vec3 middle = vec3(0.93), side = share < 0.5 ? vec3(0.0, 0.447, 0.698) : vec3(0.835, 0.369, 0.0);
          float strength = abs(2.0 * share - 1.0);
          vec3 own = differences ? mix(middle, side, strength) : mix(dark, bright, share);
          float seen = differences ? smoothstep(0.2, 0.6, strength) : smoothstep(0.3, 0.7, share);
          vec3 colour = mix(light * own, vec3(1.0), paleness);
          gl_FragColor = vec4(colour, mix(veil, 1.0, seen));
        }`
    });
  }

  // The blocks hold all meshes, one after the other.
  function geometriesOf(positions, corners) {
    let point = 0, triangle = 0;
    return scene.meshes.map((mesh) => {
      const geometry = new THREE.BufferGeometry();
      const own = positions.subarray(3 * point, 3 * (point += mesh.points));
      geometry.setAttribute('position',
        new THREE.BufferAttribute(Float32Array.from(own, (x) => x / 32767), 3));
      geometry.setIndex(new THREE.BufferAttribute(
        corners.slice(3 * triangle, 3 * (triangle += mesh.triangles)), 1));
      geometry.computeVertexNormals();
      geometry.setAttribute('value',
        new THREE.BufferAttribute(new Uint8Array(mesh.points), 1, true));
      return geometry;
    });
  }

  // Are all points about as far from the centre?
  function round(positions) {
    let least = Infinity, most = 0;
    for (let i = 0; i < positions.length; i += 3) {
      const distance = Math.hypot(positions[i], positions[i + 1], positions[i + 2]);
      least = Math.min(least, distance);
      most = Math.max(most, distance);
    }
    return least > 0.9 * most;
  }

  async function start() {
    const [positions, indices, values] = await Promise.all(
      ['mesh-positions', 'mesh-triangles', 'frames'].map(bytesOf));
    const quantised = new Int16Array(positions);
    const frames = new Uint8Array(values);
    const geometries = geometriesOf(quantised, new Uint32Array(indices));
    const starts = [0];  // of the values of each frame
    scene.meshOf.forEach((mesh) => starts.push(starts[starts.length - 1] + scene.meshes[mesh].points));

    const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setClearColor(0xffffff);
    box.appendChild(renderer.domElement);
    const camera = new THREE.PerspectiveCamera(30, 1, 0.1, 100);
    camera.up.set(0, 0, 1);
    camera.position.set(2.9, -2.3, 1.5);
    const controls = new THREE.OrbitControls(camera, renderer.domElement);
    controls.enablePan = false;
    const canvas = renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', 'the surface; arrow keys rotate it');
    canvas.addEventListener('keydown', (event) => {
      const keys = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
      const turn = keys[event.key];
      if (!turn) return;
      event.preventDefault();
      camera.position.applyAxisAngle(camera.up, 0.1 * turn[0]);
      const aside = new THREE.Vector3().crossVectors(camera.up, camera.position).normalize();
      const tilt = camera.position.angleTo(camera.up) + 0.1 * turn[1];
      if (tilt > 0.1 && tilt < Math.PI - 0.1)
        camera.position.applyAxisAngle(aside, 0.1 * turn[1]);
      controls.update();
      draw();
    });
    const world = new THREE.Scene();
    const sides = [material(THREE.BackSide, 0.45), material(THREE.FrontSide, 0.0)];
    const layers = [];
    const add = (side, order) => {
      const mesh = new THREE.Mesh(geometries[0], side);
      mesh.renderOrder = order;
      world.add(mesh);
      layers.push(mesh);
    };
    // Where triangles overlap a veil would be painted twice, as a dark speck. Of what is round each
    // side has one layer, and only what lies in it is painted.
    const layered = round(quantised);
    sides.forEach((side, order) => {
      add(side, 2 * order + 1);
      if (!layered) return;
      const layer = side.clone();
      layer.colorWrite = false;
      layer.depthWrite = true;
      add(layer, 2 * order);
      side.depthFunc = THREE.EqualDepth;
    });

    const draw = () => renderer.render(world, camera);
    function fit() {
      const width = box.clientWidth;
      renderer.setSize(width, Math.min(width, 520));
      camera.aspect = width / Math.min(width, 520);
      camera.updateProjectionMatrix();
      draw();
    }
    function show(frame) {
      const geometry = geometries[scene.meshOf[frame]];
      const shown = geometry.getAttribute('value');
      shown.array.set(frames.subarray(starts[frame], starts[frame + 1]));
      shown.needsUpdate = true;
      layers.forEach((mesh) => { mesh.geometry = geometry; });
      label.textContent = scene.labels[frame];
      slider.setAttribute('aria-valuetext', scene.labels[frame]);
      document.body.dataset.frame = frame;
      draw();
    }
    controls.addEventListener('change', draw);
    window.addEventListener('resize', fit);
    slider.addEventListener('input', () => show(Number(slider.value)));
    through.addEventListener('change', () => {
      // What is opaque hides what is behind it, whichever piece is painted first.
      sides.forEach((side) => {
        side.uniforms.veil.value = through.checked ? 0.3 : 1.0;
        side.depthWrite = !through.checked;
      });
      draw();
    });
    let timer = 0;
    play.addEventListener('click', () => {
      if (timer) {
        clearInterval(timer);
        timer = 0;
      } else {
        timer = setInterval(() => {
          slider.value = (Number(slider.value) + 1) % scene.labels.length;
          show(Number(slider.value));
        }, 200);
      }
      play.textContent = timer ? 'stop' : 'play';
    });
    fit();
    show(Number(slider.value));
    document.body.dataset.ready = 'yes';
  }

  start().catch((error) => {
    label.textContent = 'no three-dimensional view: ' + error.message;
    [slider, play, through].forEach((control) => { control.disabled = true; });
    document.body.dataset.ready = 'no';
  });
})();
