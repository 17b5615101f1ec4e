// Unpacks the picture library, draws every figure of the page from the JSON beside it, and fits them to the paper when
// the page is printed. The library's hash stands in the page's policy: what was unpacked runs only if it is the same.
(function () {
  "use strict";
  // A4 less its margins at 96 dots per inch.
  var PAPER_WIDTH = 690;
  var figures = JSON.parse(document.getElementById("luztar-figures").textContent);
  var config = {
    responsive: true,
    displaylogo: false,
    modeBarButtonsToRemove: ["lasso2d", "select2d", "autoScale2d"]
  };
  var drawn = [];
  function unpacked(id) {
    var letters = atob(document.getElementById(id).textContent.trim());
    var bytes = Uint8Array.from(letters, function (letter) { return letter.charCodeAt(0); });
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
  }
  function draw() {
    document.querySelectorAll("[data-figure]").forEach(function (place) {
      var figure = figures[place.getAttribute("data-figure")];
      if (!figure) { return; }
      place.textContent = "";
      drawn.push(place);
      Plotly.newPlot(place, figure.data, figure.layout, config);
    });
    document.documentElement.setAttribute("data-drawn", String(drawn.length));
  }
  unpacked("luztar-plotly").then(function (text) {
    var library = document.createElement("script");
    library.textContent = text;
    document.head.appendChild(library);
    draw();
  });
  window.addEventListener("beforeprint", function () {
    drawn.forEach(function (place) { Plotly.relayout(place, { autosize: false, width: PAPER_WIDTH }); });
  });
  window.addEventListener("afterprint", function () {
    drawn.forEach(function (place) { Plotly.relayout(place, { autosize: true, width: null }); });
  });
})();
