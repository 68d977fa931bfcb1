// Moves between entries and enlarges pictures. The page is whole without it.
(() => {
  const entries = [...document.querySelectorAll('section.entry')];
  const box = document.createElement('dialog');
  const image = document.createElement('img');
  const words = document.createElement('p');
  const close = document.createElement('button');
  close.textContent = 'Close';
  close.onclick = () => box.close();
  box.append(words, image, close);
  document.body.append(box);
  let current = -1;
  let kind = 'failure';

  const seen = () => {
    const middle = innerHeight / 2;
    const index = entries.findIndex((entry) => entry.getBoundingClientRect().bottom >= middle);
    return index === -1 ? entries.length - 1 : index;
  };
  const figure = () => entries[current].querySelector('figure.' + kind);
  const enlarge = () => {
    const from = figure();
    if (!from) return;
    image.src = from.querySelector('img').src;
    image.alt = from.querySelector('img').alt;
    words.textContent = entries[current].querySelector('h2').textContent + ': ' + from.querySelector('figcaption').textContent;
    if (!box.open) box.showModal();
  };
  // The entry that has the focus, if it is in view; else the last one that begins above.
  const here = () => {
    const focused = document.activeElement.closest('section.entry');
    const place = focused ? focused.getBoundingClientRect() : null;
    const isSeen = place ? Math.min(innerHeight - place.top, place.bottom) > 0 : false;
    return isSeen ? entries.indexOf(focused) : entries.findLastIndex((entry) => 12 >= entry.getBoundingClientRect().top);
  };
  const go = (step) => {
    current = Math.min(Math.max((box.open ? current : here()) + step, 0), entries.length - 1);
    entries[current].scrollIntoView();
    entries[current].focus({ preventScroll: true });
    if (box.open) enlarge();
  };
  const kinds = { f: 'failure', c: 'cure', t: 'truth', d: 'difference' };

  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === 'ArrowRight') go(1);
    else if (event.key === 'ArrowLeft') go(-1);
    else if (kinds[event.key]) {
      if (!box.open) current = seen();
      kind = kinds[event.key];
      enlarge();
    } else return;
    event.preventDefault();
  });
  document.addEventListener('click', (event) => {
    const link = event.target.closest('a[data-picture]');
    if (!link) return;
    event.preventDefault();
    current = entries.indexOf(link.closest('section.entry'));
    kind = link.dataset.picture;
    enlarge();
  });
})();
